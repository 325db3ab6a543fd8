"""`python3 report DIR`: started by `farcull report`, with what it must know as JSON in the
environment variable FARCULL_REPORT (the program, its commit, its studies and constants)."""
