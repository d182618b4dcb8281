#!/bin/sh
# The same with shared libraries: sonames, and only asp_* visible.
exec sh "$1/tests/install/run.sh" shared "$1" "$2"
