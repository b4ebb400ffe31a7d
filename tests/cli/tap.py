# SPDX-License-Identifier: MIT
"""What the tests of command-line tools share: the tools by name, running them, reading their tables, printing TAP.

The paths of the tools are the arguments of the program.
"""
import os
import subprocess
import sys
import tempfile

PATHS = {os.path.basename(path): os.path.abspath(path) for path in sys.argv[1:]}

count = failures = 0


def check(passed, name, detail=''):
    global count, failures
    count += 1
    failures += not passed
    print(f'{"ok" if passed else "not ok"} {count} - {name}')
    if not passed and detail:
        print('\n'.join('# ' + line for line in str(detail).splitlines()), flush=True)


def equal(got, want, name):
    check(got == want, name, f'got  {got!r}\nwant {want!r}')


def run(tool, *args, **how):
    how = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'timeout': 60, **how}
    return subprocess.run([PATHS[tool], *args], stdin=subprocess.DEVNULL, text=True, check=False, **how)


def in_shell(script, tool, *args):
    """Run a script in which "$@" is the tool with its arguments."""
    return subprocess.run(['sh', '-c', script, 'sh', PATHS[tool], *args], capture_output=True, text=True, timeout=60,
                          check=False)


def parse(text):
    """The rows of a table as dictionaries of strings."""
    lines = [line for line in text.splitlines() if not line.startswith('#')]
    names = lines[0].split('\t')
    return [dict(zip(names, line.split('\t'), strict=True)) for line in lines[1:]]


def table(tool, *args):
    result = run(tool, *args)
    if result.returncode != 0 or result.stderr != '':
        check(False, f'{tool} {" ".join(args)} runs silently', f'status {result.returncode}\n{result.stderr}')
    return parse(result.stdout)


def column(rows, name):
    return [float(row[name]) for row in rows]


def run_tests(names):
    """Run every function test_...() among names; one that takes an argument gets an empty folder."""
    for name, test in list(names.items()):
        if name.startswith('test_') and test.__code__.co_argcount == 0:
            test()
        elif name.startswith('test_'):
            with tempfile.TemporaryDirectory() as folder:
                test(folder)
    print(f'1..{count}')
    return 1 if failures else 0
