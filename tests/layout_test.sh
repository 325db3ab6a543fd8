#!/usr/bin/env bash
# Checks the layout of the repository: which folder includes which, which libraries a folder uses, which file starts threads,
# that core names no option of the command line, that a type has its name alone in its namespace, where source files lie, and
# that the paths named in the pages exist. The rules are in layout_test.py.
#   tests/layout_test.sh [ROOT]          checks ROOT (default: this repository). It prints one line for each violation, and
#                                        then exits with status 1.
#   tests/layout_test.sh --graph [ROOT]  prints the folders by level and the arrows between them
#   tests/layout_test.sh --self-test     breaks each rule in a temporary tree and checks that the violation is reported
exec python3 "${BASH_SOURCE[0]%.sh}.py" "$@"
