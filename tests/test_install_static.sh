#!/bin/sh
# Installing, and using what was installed: the static libraries of this build.
exec sh "$1/tests/install/run.sh" static "$1" "$2"
