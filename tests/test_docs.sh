#!/bin/sh
# Everything that a command produces is current: pages, tables, pictures, the single-file core.
exec "$1/scripts/docs.sh" --check "$2"
