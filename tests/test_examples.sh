#!/bin/sh
# Every example, and the README's first program, built and run by the command that stands in it, its
# output compared with what stands beside it. UPDATE=1 writes the examples' outputs instead.
set -eu
source=$1 build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0

cmake --install "$build" --prefix "$scratch/prefix" >"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; echo "0 passed, 1 failed"; exit 1; }
PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name asperity.pc)")
export PKG_CONFIG_PATH
# The core is the same one file in most of the commands: compiled once, it stands in for its source.
mkdir "$scratch/tree" "$scratch/bin"
compiler=$(command -v cc)
core=$build/tests/objects/core.o
make -C "$source" -f tests/objects.mk OUT="$build/tests/objects" "$core"
cat >"$scratch/bin/cc" <<EOF
#!/bin/sh
n=\$#
for a; do
    [ "\$a" != src/asperity_core.c ] || a=$core
    set -- "\$@" "\$a"
done
shift "\$n"
exec "$compiler" "\$@"
EOF
chmod +x "$scratch/bin/cc"
PATH=$scratch/bin:$PATH
cd "$scratch/tree"
ln -s "$source/include" "$source/src" "$source/examples" .

# try NAME COMMAND EXPECTED-FILE
try() {
    if ! sh -c "$2" >"$scratch/output" 2>"$scratch/errors"; then
        echo "FAILED $1: $2"
        cat "$scratch/output" "$scratch/errors"
        failed=$((failed + 1))
    elif [ "${UPDATE:-}" = 1 ] && [ "$1" != README ]; then
        cp "$scratch/output" "$3"
        echo "wrote $3"
    elif ! diff -u "$3" "$scratch/output"; then
        echo "FAILED $1: another output"
        failed=$((failed + 1))
    else
        echo "ok: $1"
        passed=$((passed + 1))
    fi
}

for example in "$source"/examples/*.c; do
    command=$(sed -n 's/^ \*     \(cc .*\)$/\1/p' "$example")
    case $command in
    cc*) try "$(basename "$example")" "$command" "${example%.c}.txt" ;;
    *) echo "FAILED $example: no command in its first comment"; failed=$((failed + 1)) ;;
    esac
done

# README: the first block of C is first.c, the command that begins with cc builds it, and the block of
# text after that is what it prints
awk '/^```c$/ { on = 1; next } /^```/ { if (on) exit } on' "$source/README.md" >first.c
command=$(sed -n 's/^\(cc .*first\.c.*\)$/\1/p' "$source/README.md")
awk '/^cc .*first\.c/ { seen = 1 } seen && /^```text$/ { on = 1; next } /^```/ { if (on) exit } on' \
    "$source/README.md" >expected
case $command in
cc*) try README "$command" expected ;;
*) echo "FAILED README: no command"; failed=$((failed + 1)) ;;
esac

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
