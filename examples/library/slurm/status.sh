#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# status.sh JOB: prints success, running or failed, as Snakemake expects. A controller that does not answer does not
# mean that a job has ended, and Slurm itself starts the jobs of a dead node again; a job that it has forgotten is
# asked for in the accounts, where a cluster has them.
set -u
answer=$(scontrol --oneliner show job "$1" 2>&1)
case $answer in
*JobState=*) state=${answer#*JobState=} ;;
*"Invalid job id"*) state=$(sacct --noheader --allocations --format=state --jobs "$1" 2>/dev/null) ;;
*) state=RUNNING ;;
esac
case ${state%% *} in
COMPLETED) echo success ;;
RUNNING | PENDING | CONFIGURING | COMPLETING | SUSPENDED | PREEMPTED | REQUEUED | NODE_FAIL | BOOT_FAIL)
    echo running
    ;;
*) echo failed ;;
esac
