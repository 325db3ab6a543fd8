#!/usr/bin/env bash
# Checks the layout of the repository: which folder includes which, which libraries a folder uses, which file starts threads,
# that core, offsets and verify have no word of the command line or of stages, that a type has its name alone in its namespace,
# where files lie, and that paths in pages exist.
#   tests/layout_test.sh [ROOT]          prints one line for each violation in ROOT (default: this repository); status 1 then
#   tests/layout_test.sh --graph [ROOT]  prints the folders by level and the arrows between them
#   tests/layout_test.sh --self-test     breaks each rule in a temporary tree and checks that the violation is reported
exec python3 "${BASH_SOURCE[0]%.sh}.py" "$@"
