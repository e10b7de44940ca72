# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""A cluster on one machine: Slurm with two nodes, and two hosts of ssh.

It lives in namespaces of its own, with its own network, /run and configuration, so that nothing of this machine's own
Slurm, munge or ssh is touched, and all of it ends with the process that enters first. A node is a PID namespace:
killing it kills the daemon and the jobs on it, as a power failure does."""
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

NODES = ("node1", "node2")
# getaddrinfo() of glibc takes a machine with nothing but 127.0.0.1 for one without IPv4.
ADDRESS = "10.77.0.1"
ENTERED = "GST_SPIDAR_CLUSTER"
PRIVATE_FOLDERS = ("/run", "/etc/slurm", "/etc/munge", "/var/lib/munge", "/var/log/munge")

SLURM_CONF = """
ClusterName=library
SlurmctldHost=head({address})
SlurmUser=root
StateSaveLocation={folder}/state
SlurmctldPidFile=/run/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/%n
SlurmdPidFile=/run/slurmd-%n.pid
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_res
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
# A node counts as down after 10 s, and is used again when it comes back.
SlurmdTimeout=10
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=2
NodeName=node1 NodeAddr={address} Port=17001 CPUs=1 RealMemory=1000
NodeName=node2 NodeAddr={address} Port=17002 CPUs=1 RealMemory=1000
PartitionName=films Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""

SSHD_CONFIG = """
Port {port}
ListenAddress {address}
HostKey {folder}/key
AuthorizedKeysFile {folder}/key.pub
StrictModes no
UsePAM no
PidFile none
"""


def enter():
    """Starts this program again in namespaces of its own, as root of this machine."""
    if os.environ.get(ENTERED):
        return
    if os.geteuid() != 0:
        sys.exit("error: a cluster in namespaces needs root: run sudo meson test -C build --suite library")
    os.environ[ENTERED] = "1"
    os.execvp("unshare", ["unshare", "--mount", "--net", "--uts", "--pid", "--fork", "--kill-child", "--mount-proc",
                          "--propagation", "private", sys.executable, *sys.argv])


def run(*command, **options):
    """What a command prints; raises CalledProcessError when it fails."""
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def wait_for(condition, what, seconds=120):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            sys.exit(f"error: {what} did not come within {seconds} s")
        time.sleep(0.2)


class Cluster:
    def __init__(self, folder: Path):
        self.folder = folder
        for name in ("state", *NODES):
            (folder / name).mkdir(parents=True)
        self.hosts = {}  # processes by node
        self._own_the_machine()
        self._start_munge()
        Path("/etc/slurm/slurm.conf").write_text(SLURM_CONF.format(address=ADDRESS, folder=folder))
        run("slurmctld")
        for node in NODES:
            self.start(node)
        wait_for(lambda: run("sinfo", "--noheader", "--Node", "--format=%T").split() == ["idle"] * 2,
                 "two idle nodes of Slurm")
        run("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / "key")

    def _own_the_machine(self):
        for name in PRIVATE_FOLDERS:
            Path(name).mkdir(parents=True, exist_ok=True)
            run("mount", "-t", "tmpfs", "-o", "mode=755", "tmpfs", name)
        hosts = Path("/run/hosts")
        hosts.write_text(f"127.0.0.1 localhost\n{ADDRESS} head {' '.join(NODES)}\n")
        run("mount", "--bind", hosts, "/etc/hosts")
        run("ip", "link", "set", "lo", "up")
        run("ip", "address", "add", f"{ADDRESS}/32", "dev", "lo")
        run("hostname", "head")

    def _start_munge(self):
        Path("/run/munge").mkdir()
        Path("/etc/munge/munge.key").write_bytes(os.urandom(128))
        os.chmod("/etc/munge/munge.key", 0o400)
        for name in ("/run/munge", "/etc/munge", "/etc/munge/munge.key", "/var/lib/munge", "/var/log/munge"):
            shutil.chown(name, "munge", "munge")
        run("setpriv", "--reuid=munge", "--regid=munge", "--clear-groups", "munged", "--force")

    def start(self, node):
        """The node's daemon, with all that it starts, in a PID namespace."""
        self.hosts[node] = subprocess.Popen(
            ["unshare", "--uts", "--pid", "--fork", "--kill-child", "--mount-proc", "sh", "-c",
             f"hostname {node} && exec slurmd -D"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def power_off(self, node):
        self.hosts[node].send_signal(signal.SIGKILL)
        self.hosts[node].wait()

    def start_ssh(self, node):
        """The arguments of ssh that reach it."""
        port = 2201 + NODES.index(node)
        config = self.folder / f"sshd-{node}"
        config.write_text(SSHD_CONFIG.format(port=port, address=ADDRESS, folder=self.folder))
        Path("/run/sshd").mkdir(exist_ok=True)
        self.hosts[f"ssh {node}"] = subprocess.Popen(
            ["unshare", "--uts", "--pid", "--fork", "--kill-child", "--mount-proc", "sh", "-c",
             f"hostname {node} && exec /usr/sbin/sshd -D -f {config}"], stdin=subprocess.DEVNULL)
        return (f"ssh -p {port} -i {self.folder}/key -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null "
                f"-o LogLevel=ERROR {node}")
