# SPDX-License-Identifier: MIT
"""Common functions of the tests of command-line tools: their names, running them, reading their tables."""
import functools
import os
import re
import shutil
import subprocess

import pytest

BY_METHOD = ORDER, RUN, ENERGY = 'spring-order', 'spring-run', 'spring-energy'  # these have --method, --arithmetic
VALIDATE, STABILITY, ROUNDING = 'spring-validate', 'spring-stability', 'spring-rounding'
SCENE, MAP = 'spring-scene', 'spring-scene-map'
PLAN = 'spring-plan'  # with --presets it measures no time
METHOD_TABLE = 'spring-methods'
CONTACTS = 'spring-contacts'
SWEEP = 'spring-sweep'
BENCH, WORK = 'spring-bench', 'spring-work'  # measure time: no two runs give the same bytes
ENGINES = 'spring-engines'  # built where there are engines
USERS = METHOD_TABLE, PLAN, RUN, SCENE, SWEEP  # installed; the others are for the study
SHORT = {  # for every tool that gives the same bytes twice a run that takes no time
    ORDER: ['--method', 'euler', '--n-max', '50'],
    RUN: ['--method', 'rk4', '--duration', '3', '--steps', '30', '--every', '1'],
    ENERGY: ['--method', 'leapfrog', '--duration', '10'],
    VALIDATE: ['--case', 'fast-root'],
    STABILITY: ['--map', '--points', '2'],
    ROUNDING: ['--method', 'rk4', '--sum', 'plain', '--steps', '1e4'],
    SCENE: ['--scene', 'rope', '--method', 'leapfrog', '--duration', '0.1'],
    MAP: ['--scene', 'chain', '--method', 'rk4', '--quick'],
    SWEEP: ['--over', 'omega_dt=0.1:3:log:3', '--method', 'rk4', '--scene', 'spring'],  # the last takes one word
    PLAN: ['--presets', '--scene', 'chain', '--quick'],
    METHOD_TABLE: [],
    CONTACTS: ['--quick'],
}
TIMED = {  # for the others
    BENCH: ['--quick', '--kernel', 'leapfrog'],
    WORK: ['--quick', '--problem', 'ideal-1'],
}
if shutil.which(ENGINES):
    TIMED[ENGINES] = ['--quick', '--engine', 'bullet']
EVERY = SHORT | TIMED
every_tool = pytest.mark.parametrize('tool', EVERY)
each_tool = pytest.mark.parametrize('tool', SHORT)


# What a run may be remarked on.
NEVER_STABLE = r'no step of \S+ is stable here'
NOT_STABLE = r'the step of \S+ s is not below the stable step of \S+ here, \S+ s'
NOT_WHOLE = r'a duration of \S+ s is not a whole number of steps of \S+ s: the run takes \d+ and ends at \S+ s'


def run(tool, *args, **how):
    how = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'timeout': 200, **how}
    return subprocess.run([tool, *args], stdin=subprocess.DEVNULL, text=True, check=False, **how)


def in_little_memory(*args):
    """A run that must not keep what it reads: 300 MB are far more than programs and sanitizers need."""
    with subprocess.Popen(args, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        out, err = process.stdout.read(), process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert usage.ru_maxrss < 300e3
    return subprocess.CompletedProcess(args, process.returncode, out, err)


def parse(text):
    """The rows of a table as dictionaries of strings."""
    lines = [line for line in text.splitlines() if not line.startswith('#')]
    names = lines[0].split('\t')
    return [dict(zip(names, line.split('\t'), strict=True)) for line in lines[1:]]


def table(tool, *args, remarks=()):
    """The rows of a run that is done, with these remarks and no other word."""
    result = run(tool, *args)
    said = result.stderr.splitlines()
    assert (result.returncode, len(said)) == (0, len(remarks)), (result.args, said)
    assert all(re.fullmatch(f'{tool}: {remark}', line) for remark, line in zip(remarks, said)), said
    return parse(result.stdout)


def column(rows, name):
    return [float(row[name]) for row in rows]


def is_failure(result, status, *words):
    """One message, of the tool's, that has these words; nothing else is printed."""
    assert (result.returncode, result.stdout or '') == (status, '')
    message, = result.stderr.splitlines()
    assert message.startswith(f'{result.args[0]}: ')
    assert [word for word in words if word not in message] == [], message


def choices(tool, option):
    """What the tool says an option should be."""
    return run(tool, option, 'nonsense').stderr.rstrip('\n').partition('is not one of ')[2].split(', ')


METHODS = choices(RUN, '--method')
STEPPERS = [method for method in METHODS if method != 'exact']
SCENE_STEPPERS = choices(SCENE, '--method')


STAGES = 'rk4 --arithmetic stages'


@functools.cache
def order(method):
    row, = (row for row in table('spring-methods') if row['method'] == method)
    return int(row['order'])
