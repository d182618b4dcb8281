"""test_floors.py COMMAND SOURCE - the rules of the tree

A lower floor never includes an upper one; the core calls neither malloc nor stdio and keeps no
global state; kernels use no libm but the square root; no file is long; and every hot loop is
vectorised by gcc (the compiler's own report is read). Standard library only.
"""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

# Lowest first. Folders in one set stand on one floor and may use each other.
FLOORS = [
    {'include/asperity'},
    {'src/ndf'},
    {'src/bsdf'},
    {'src/core'},
    {'src/data', 'src/surface'},
    {'src/fit', 'src/laws'},
    {'src/draw', 'src/render'},
    {'tools'},
]
# Public headers belong to the floor that they are the face of.
HEADERS = {
    'include/asperity.h': 0, 'include/asperity_ndf.h': 0,
    'include/asperity_study.h': 0, 'include/asperity_convert.h': 0,
    'include/asperity_data.h': 4, 'include/asperity_draw.h': 6,
}
CORE = 3                      # the floors up to here make the core library
LONGEST = 600
LIBM = ('sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 '
        'log10 log1p pow cbrt hypot erf erfc tgamma lgamma fmod remainder fma ldexp frexp fmin fmax '
        'floor ceil round trunc rint nearbyint').split()
FORBIDDEN = ('malloc calloc realloc free printf fprintf sprintf snprintf puts fopen exit abort getenv '
             'rand srand time clock').split()

passed = failed = 0


def expect(ok, what):
    global passed, failed
    if ok:
        passed += 1
    else:
        failed += 1
        print('  FAILED:', what)


def floor_of(path):
    text = path.as_posix()
    if text in HEADERS:
        return HEADERS[text]
    if text == 'src/asperity_core.c':      # the core as one file
        return CORE
    for number, folders in enumerate(FLOORS):
        if path.parent.as_posix() in folders:
            return number
    return None


def without_comments(text):
    """Comments, strings and characters blanked; line numbers stay."""
    def blank(match):
        return re.sub(r'[^\n]', ' ', match.group(0))
    return re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', blank, text,
                  flags=re.S)


def includes(path, text):
    """(line number, file included) of the project's own files."""
    code = re.sub(r'/\*.*?\*/', lambda m: re.sub(r'[^\n]', ' ', m.group(0)), text, flags=re.S)
    for number, line in enumerate(code.splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        if not match:
            continue
        name = match.group(1)
        for base in (path.parent, Path('include'), Path('src'), Path('.')):
            if (base / name).is_file():
                yield number, Path((base / name).as_posix())
                break


def sources(*folders, endings=('.c', '.h', '.def')):
    for folder in folders:
        for path in sorted(Path(folder).rglob('*')):
            if path.suffix in endings and path.is_file():
                yield path


def check_includes():
    print('includes')
    for path in sources('include', 'src', 'tools'):
        floor = floor_of(path)
        expect(floor is not None, f'{path}: a folder that has no floor')
        if floor is None:
            continue
        for line, other in includes(path, path.read_text()):
            above = floor_of(other)
            expect(above is not None and above <= floor,
                   f'{path}:{line} includes {other}, from a floor above')
        if path.parent.as_posix() in ('src/draw', 'src/render'):
            for line, other in includes(path, path.read_text()):
                expect(not other.as_posix().startswith('src/fit/'),
                       f'{path}:{line}: drawing sees the inside of fit')


def check_core():
    print('core: no allocation, no stdio, no clock')
    for path in sources('include', 'src'):
        floor = floor_of(path)
        if floor is None or floor > CORE or path.as_posix() in HEADERS and HEADERS[path.as_posix()]:
            continue
        text = path.read_text()
        code = without_comments(text)
        for header in re.findall(r'#\s*include\s*<([^>]+)>', text):
            expect(header not in ('stdio.h', 'time.h', 'pthread.h', 'errno.h'),
                   f'{path} includes {header}')
        for name in FORBIDDEN:
            expect(not re.search(rf'(?<![\w.>]){name}\s*\(', code), f'{path} calls {name}')


def kernel_text(path):
    """The part of a file that is a kernel: all of a kernel header, the body of a file that reads
    itself once per precision."""
    text = without_comments(path.read_text())
    if path.suffix == '.h':
        return text
    raw = path.read_text()
    match = re.search(r'^#else\s*\n#include "asperity/', raw, re.M)
    return text[match.start():] if match else ''


def check_kernels():
    print('kernels: no libm but the square root')
    paths = list(sources('include/asperity', endings=('.h',)))
    paths += [p for p in sources('src/ndf', 'src/bsdf') if p.suffix in ('.c', '.h')]
    paths += [Path('src/core/facets.c'), Path('src/core/material.c'), Path('src/core/blocks.h'),
              Path('src/core/fresnel.c')]
    bodies = 0
    for path in paths:
        if not path.is_file():
            continue
        code = kernel_text(path)
        bodies += bool(code.strip())
        for name in LIBM:
            for form in (name, name + 'f'):
                expect(not re.search(rf'(?<![\w.>]){form}\s*\(', code),
                       f'{path}: {form} in a kernel')
    expect(bodies >= 8, f'only {bodies} kernels found')


def check_lengths():
    print(f'no file of more than {LONGEST} lines')
    for path in sources('include', 'src', 'tools', 'tests', 'bench', 'examples',
                        endings=('.c', '.h', '.py', '.sh', '.js', '.mjs', '.cmake')):
        lines = path.read_text(errors='replace').count('\n')
        expect(lines <= LONGEST, f'{path}: {lines} lines')


def check_vectorised(command):
    """Every loop `for (i = 0; i < n` of the batch files, in both precisions, in every distribution
    and scattering model. 32-byte vectors: the report must not be satisfied by a loop's remainder."""
    print('hot loops are vectorised')
    if not shutil.which('gcc') or not shutil.which('make'):
        print('  gcc or make is absent: left out')
        return
    # as test_bits has them, which has mostly compiled them already
    folder = Path(command).resolve().parent / 'tests' / 'objects'
    made = subprocess.run(['make', '-k', '-j2', '-f', 'tests/objects.mk', f'OUT={folder}', 'gcc-avx2'],
                          capture_output=True, text=True)
    expect(made.returncode == 0, 'the core does not compile: ' + made.stderr[:1000])
    hot = [Path('include/asperity/ndf_loops.h'), Path('src/bsdf/bsdf_loops.h'), Path('src/core/facets.c'), Path('src/core/material.c'),
           Path('src/core/material_batch.c'), Path('src/core/sggx.c')]
    hot += sorted(Path('src/core').glob('*_loops.h'))
    hot += sorted(Path('src/ndf').glob('*.h'))
    hot += [Path('src/ndf/ggx.c'), Path('src/ndf/histogram_rows.c'), Path('src/bsdf/dielectric.c')]
    # what prepares, in float64 alone
    once = [Path(f'src/ndf/{name}.c') for name in ('prepared_area', 'prepared_sight', 'abc', 'gtr', 'sgd',
                                                   'torrance_sparrow')]
    hot += once
    loops, replaced, single = {}, {}, set()
    for path in hot:
        if not path.is_file():
            continue
        loops[path.as_posix()] = []
        in_own, in_single = None, False
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'#ifndef (ASP_OWN_\w+)', line)
            in_own = match.group(1) if match else in_own if '#endif' not in line else None
            in_single = '#if ASP_PRECISION == 32' in line or in_single and '#endif' not in line
            if re.search(r'for \(i = 0; i < n\b', line):
                loops[path.as_posix()].append(number)
                if in_own:
                    replaced[path.as_posix(), number] = in_own
                if in_single:
                    single.add((path.as_posix(), number))
    total = 0
    units = sorted(Path('src/ndf').glob('*.c')) + sorted(Path('src/bsdf').glob('*.c'))
    units += [p for p in sorted(Path('src/core').glob('*.c'))]
    for unit in units:
        if 'ASP_PRECISION 32' not in unit.read_text() and unit not in hot:
            continue                      # makers and tables
        if 'define ASP_SCALAR_LOOPS' in unit.read_text():
            continue                      # one by one, as a file says that vectorises something else
        report = (folder / 'gcc-avx2' / unit).with_suffix('.vec')
        expect(report.is_file(), f'{unit}: no report on its loops')
        seen = {}
        for path, line in re.findall(r'^([^:\n]+):(\d+):\d+: optimized: loop vectorized using 32',
                                     report.read_text() if report.is_file() else '', re.M):
            seen[(Path(path).as_posix(), int(line))] = seen.get(
                (Path(path).as_posix(), int(line)), 0) + 1
        # a header's loops count where the unit reads the header
        included, rest = set(), [unit]
        while rest:
            path = rest.pop()
            if path.as_posix() not in included:
                included.add(path.as_posix())
                rest += [o for _, o in includes(path, path.read_text())]
        own = {name for p in included
               for name in re.findall(r'#define (ASP_OWN_\w+)', Path(p).read_text())}
        for path in included & set(loops):
            for line in loops[path]:
                if replaced.get((path, line)) in own and (path, line) not in seen:
                    continue              # it brings its own, which are in its files
                total += 1
                count = seen.get((path, line), 0)
                # in both precisions, but for what one precision has or replaces
                least = 1 if (path, line) in single or Path(path) in once or \
                    replaced.get((path, line)) in own else 2
                expect(count >= least, f'{unit}: the loop at {path}:{line} is vectorised '
                                       f'{count} times, it would be {least} or more')
    print(f'  {total} loops in {len(units)} files')
    expect(total >= 20, f'only {total} hot loops found')


def check_state(command):
    """No writable data in the core's objects (nm: b, B, C; constants that hold pointers are d)."""
    library = Path(command).resolve().parent / 'libasperity.a'
    nm = shutil.which('nm')
    if not nm or not library.is_file():
        print('no static core library or no nm: its global state is not looked at')
        return
    print('core: no global state')
    table = subprocess.run([nm, str(library)], capture_output=True, text=True).stdout
    variables = [line.split()[-1] for line in table.splitlines()
                 if re.match(r'[0-9a-f]+ [bBC] ', line)]
    # the sanitizers keep a guard of their own
    variables = [v for v in variables if 'asan' not in v and 'ubsan' not in v]
    expect(not variables, f'variables in the core: {", ".join(variables)}')


def check_self():
    """The checks themselves: a violation must be seen."""
    print('the checks see a violation')
    text = '/* #include "fit/fit.h" */\n#include "fit/fit.h"\n'
    expect([line for line, _ in includes(Path('src/ndf/x.c'), text)] == [2],
           'an include is found, and not in a comment')
    expect(floor_of(Path('src/fit/fit.h')) > floor_of(Path('src/ndf/ggx.c')), 'fit is above ndf')
    code = without_comments('y = exp(x); /* log(x) */ s = "pow(x)"; aspi_exp(x);')
    expect(re.search(r'(?<![\w.>])exp\s*\(', code) and 'log(' not in code and 'pow(' not in code,
           'a call is found, and not in a comment or string')


def main():
    command = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else Path('asperity')
    os.chdir(sys.argv[2] if len(sys.argv) > 2 else Path(__file__).resolve().parent.parent)
    check_self()
    check_includes()
    check_core()
    check_kernels()
    check_lengths()
    check_state(command)
    check_vectorised(command)
    print(f'{passed} passed, {failed} failed')
    return failed != 0


if __name__ == '__main__':
    sys.exit(main())
