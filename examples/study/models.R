#!/usr/bin/env Rscript
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Mixed models of a folder that `study.py export` wrote, to compare with its report:
#   Rscript models.R FOLDER
# Of each question and pair of conditions, the odds ratio of a higher answer (ordinal::clmm) and the difference in steps
# (lme4::lmer); people and clips may differ in their level and in their effect. Both intervals take the normal
# distribution however few the clips are, and are too narrow for few. Needs r-cran-ordinal and r-cran-lme4.
suppressMessages({
  library(ordinal)
  library(lme4)
})
folder <- commandArgs(TRUE)[1]
files <- Sys.glob(file.path(folder, "sub-*", "beh", "*_beh.tsv"))
if (length(files) == 0) stop(folder, ": there is no sub-*/beh/*_beh.tsv in it; study.py export writes them")
read <- function(file) {
  rows <- read.delim(file, na.strings = "n/a", stringsAsFactors = FALSE)
  rows$participant <- sub("_.*", "", basename(file))
  rows
}
rows <- do.call(rbind, lapply(files, read))
pairs <- list(c("linear", "nonlinear"), c("without", "with"), c("sham", "with"))

fitted <- function(model) tryCatch(suppressMessages(suppressWarnings(model())), error = function(problem) NULL)

cat("question\tfirst\tsecond\tpeople\tclips\todds_ratio\tlow\thigh\tp\tsteps\tsteps_low\tsteps_high\n")
for (question in unique(rows$question)) for (pair in pairs) {
  d <- rows[rows$question == question & rows$condition %in% pair, ]
  if (length(unique(d$condition)) < 2 || length(unique(d$response)) < 2) next
  d$second <- ifelse(d$condition == pair[2], 0.5, -0.5)
  d$step <- factor(d$response)
  d$participant <- factor(d$participant)
  d$clip <- factor(d$clip)
  right <- if (nlevels(d$clip) > 1) "second + (second | participant) + (second | clip)" else "second + (second | participant)"
  ordered <- fitted(function() clmm(as.formula(paste("step ~", right)), data = d))
  linear <- fitted(function() lmer(as.formula(paste("response ~", right)), data = d))
  odds <- if (is.null(ordered)) rep(NA, 4) else coef(summary(ordered))["second", c(1, 2, 4)]
  steps <- if (is.null(linear)) rep(NA, 2) else coef(summary(linear))["second", 1:2]
  cat(question, pair, nlevels(d$participant), nlevels(d$clip),
      signif(exp(odds[1] + c(0, -1.96, 1.96) * odds[2]), 4), signif(odds[3], 3),
      signif(steps[1] + c(0, -1.96, 1.96) * steps[2], 5), sep = "\t")
  cat("\n")
}
