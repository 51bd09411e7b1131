# What R says of tables of paired samples, for r_test.cc. One process for all tables.
#   Rscript --vanilla reference.R TABLES
# TABLES: a line each: participants, conditions, then the values row by row. Prints a line of
# numbers a table, in the order of r_test.cc; "NA" is not defined, "skip" is not known to R.

say <- function(x) {
  paste(ifelse(is.na(x), "NA", sprintf("%.17g", x)), collapse = " ")
}

exact_wilcoxon <- function(d) {
  d <- d[d != 0]
  n <- length(d)
  if (n == 0) return("NA")
  r <- rank(abs(d))
  if (n <= 12) {  # all signs
    sums <- 0
    for (x in r) sums <- c(sums, sums + x)
    mean <- sum(r) / 2
    return(say(mean(abs(sums - mean) >= abs(sum(r[d > 0]) - mean) - 1e-9)))
  }
  if (any(duplicated(abs(d)))) return("skip")
  v <- sum(r[d > 0])
  say(min(1, 2 * min(psignrank(v, n), psignrank(v - 1, n, lower.tail = FALSE))))
}

for (line in readLines(commandArgs(trailingOnly = TRUE)[1])) {
  numbers <- as.numeric(strsplit(line, " ")[[1]])
  n <- numbers[1]
  k <- numbers[2]
  values <- matrix(numbers[-(1:2)], n, k, byrow = TRUE)
  friedman <- suppressWarnings(friedman.test(values))
  q <- unname(friedman$statistic)
  f <- NA  # Iman and Davenport's
  if (!is.na(q) && n * (k - 1) - q > 1e-9 * n) f <- (n - 1) * q / (n * (k - 1) - q)
  out <- say(c(q, friedman$p.value, f, pf(f, k - 1, (k - 1) * (n - 1), lower.tail = FALSE)))
  p <- c()
  for (i in seq_len(k - 1)) for (j in (i + 1):k) {
    test <- suppressWarnings(wilcox.test(values[, j], values[, i], paired = TRUE, exact = FALSE,
                                         correct = FALSE))
    continuous <- suppressWarnings(wilcox.test(values[, j], values[, i], paired = TRUE, exact = FALSE,
                                               correct = TRUE))
    p <- c(p, test$p.value)
    out <- paste(out, say(c(test$statistic, test$p.value, continuous$p.value)),
                 exact_wilcoxon(values[, j] - values[, i]))
  }
  p[is.na(p)] <- 1  # no difference was seen
  out <- paste(out, say(p.adjust(p, "bonferroni")), say(p.adjust(p, "holm")))
  for (j in seq_len(k)) {
    x <- values[, j]
    half <- qt(0.975, n - 1) * sd(x) / sqrt(n)
    out <- paste(out, say(c(mean(x), sd(x), mean(x) - half, mean(x) + half,
                            quantile(x, c(0.25, 0.5, 0.75), type = 7))))
  }
  right <- sum(values[, 1] > median(values))
  out <- paste(out, say(binom.test(right, n)$conf.int),
               say(binom.test(right, n, 1 / k, alternative = "greater")$p.value))
  cat(out, "\n", sep = "")
}
