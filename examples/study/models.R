#!/usr/bin/env Rscript
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
# Mixed models of a folder that `study.py export` wrote, to compare with its report:
#   Rscript models.R FOLDER
# Of each question and pair of conditions, the odds ratio of a higher answer (ordinal::clmm) and the difference in steps
# (lmerTest::lmer, with the degrees of freedom of Satterthwaite); people and clips may differ in their level and in their
# effect, as far as there are answers to tell. The interval of the odds ratio takes the normal distribution however few the
# clips are, and is too narrow for few. note: what a model could not determine; then it has no figures (NA), or clips or
# people do not differ in it (singular). Needs r-cran-ordinal and r-cran-lmertest.
suppressMessages({
  library(ordinal)
  library(lmerTest)
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

most_s <- 300 # answers that determine nothing keep an optimizer busy
fitted <- function(model) {
  setTimeLimit(elapsed = most_s, transient = TRUE)
  on.exit(setTimeLimit())
  tryCatch(suppressMessages(suppressWarnings(model())), error = function(problem) NULL)
}

# Of the Hessian: beyond it, some direction of the parameters has no maximum that the answers determine
# (ordinal's clmm_tutorial: convergence).
most_condition <- 1e6
most_log_odds <- log(1000) # of five steps, whose thresholds are within log(4) of the middle: beyond it, all answers differ

cat("question\tfirst\tsecond\tpeople\tclips\todds_ratio\tlow\thigh\tp\tsteps\tsteps_low\tsteps_high\tdf\tsteps_p\tnote\n")
for (question in unique(rows$question)) for (pair in pairs) {
  d <- rows[rows$question == question & rows$condition %in% pair, ]
  if (length(unique(d$condition)) < 2 || length(unique(d$response)) < 2) next
  d$second <- ifelse(d$condition == pair[2], 0.5, -0.5)
  d$step <- factor(d$response)
  d$participant <- factor(d$participant)
  d$clip <- factor(d$clip)
  # With one clip, two answers of a person do not tell level and effect of the person from chance.
  is_told <- nlevels(d$clip) > 1
  right <- "second + (second | participant) + (second | clip)"
  ordered <- if (is_told) fitted(function() clmm(as.formula(paste("step ~", right)), data = d))
  linear <- if (is_told) fitted(function() lmer(as.formula(paste("response ~", right)), data = d))
  odds <- if (is.null(ordered)) rep(NA, 3) else suppressWarnings(coef(summary(ordered))["second", c(1, 2, 4)])
  note <- if (!is.null(linear) && isSingular(linear)) "singular" else character()
  curvature <- if (is.null(ordered)) NA else eigen(ordered$Hessian, symmetric = TRUE, only.values = TRUE)$values
  if (anyNA(c(odds, curvature)) || min(curvature) * most_condition < max(curvature) || abs(odds[1]) > most_log_odds) {
    odds <- rep(NA, 3)
    note <- c(note, "odds ratio not determined")
  }
  steps <- if (is.null(linear)) rep(NA, 5) else coef(summary(linear))["second", ]
  half <- if (is.null(linear)) NA else qt(0.975, steps[3]) * steps[2]
  if (is.null(linear)) note <- c(note, "difference not determined")
  cat(question, pair, nlevels(d$participant), nlevels(d$clip),
      signif(exp(odds[1] + c(0, -1.96, 1.96) * odds[2]), 4), signif(odds[3], 3),
      signif(steps[1] + c(0, -half, half), 5), signif(steps[3], 4), signif(steps[5], 3),
      paste(note, collapse = "; "), sep = "\t")
  cat("\n")
}
