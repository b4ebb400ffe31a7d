# SPDX-License-Identifier: MIT
"""Common features of the tools: options, messages, exit statuses, the form of tables, progress."""
import os
import re
import shlex
import subprocess
import time

import pytest
from tools import (BENCH, BY_METHOD, CONTACTS, ENERGY, MAP, METHODS, METHOD_TABLE, ORDER, PLAN, ROUNDING, RUN, SCENE, SCENE_STEPPERS, SHORT, STABILITY, STEPPERS,
                   SWEEP, VALIDATE, WORK, each_tool, is_failure, run, table)

METHOD = f'one of {", ".join(METHODS)}'
SCENE_STEPPER = f'one of {", ".join(SCENE_STEPPERS)}'
REAL, NOT_NEGATIVE, POSITIVE = 'a finite number', 'a finite number of at least 0', 'a finite number greater than 0'
COUNT_1, COUNT_53 = 'a whole number of at least 1', 'a whole number from 1 to 9007199254740992'
SCENE_NAME = 'one of rope, cloth, jelly, chain, water'
POKE = '5 finite numbers separated by commas, T,X,Y,FORCE,AREA'

COLUMNS = {  # the fixed ones, in their order; others may follow
    ORDER: 'method n dt_s error_m',
    RUN: 'method step t_s x_m v_m_per_s energy_J exact_x_m error_m',
    ENERGY: 'method velocity duration_s steps energy_error_J',
    VALIDATE: 'case method witness dt_s steps error bound verdict',
    STABILITY: 'method omega_dt damping_ratio error',  # of --map
    ROUNDING: 'method sum start steps dt_s state_error energy_error',
    SCENE: 't_s energy_J kinetic_J elastic_J gravity_J max_displacement_m',
    SWEEP: 'omega_dt method error energy_error status',
    PLAN: 'scene method error substeps dt_s measured_error uncertainty stable_substeps',  # of --presets
    CONTACTS: 'case scheme dt_s value exact error order',
    METHOD_TABLE: 'method label order forces_per_step symplectic springs scenes',
    MAP: 'scene method particles links substeps dt_s stable_step_s energy_error verdict',
}
NOT_AN_OPTION = ['foo', '', '-', '--', '-x', '-output', '-output=x', '-out', '-out=x', '-o=x', '--bogus', '--bogus=1', '--meth', '--outpu',
                 '--vers', '-help']

REFUSED_VALUES = [  # of a tool, options, values; what each should be
    *[(tool, '--method', ['foo', '', 'Euler', 'eul', 'euler '], METHOD) for tool in BY_METHOD],
    *[(tool, '--output', [''], 'the name of a file') for tool in SHORT],
    (RUN, '--steps', ['0', '9007199254740993', '-1', '+1', '', ' 1', '1 ', '1.5', '0x10', 'ten', '1e', '1e-1', '1e20',
                      '2e19', '18446744073709551616', '1e99999999999999999999', 'nan', 'inf'], COUNT_53),
    (RUN, '--duration', ['0', '-1', '', ' 1', '1 ', '1s', '1e999', '-1e999', '1e-999', 'nan', 'inf', '1,5', '1e', '.'],
     POSITIVE),
    (RUN, '--mass', ['-1', '0', '-0', 'nan', '1e999'], POSITIVE),
    (RUN, '--stiffness --damping', ['-1', '', 'nan', 'infinity', '1e999'], NOT_NEGATIVE),
    (RUN, '--load --x0 --v0 --from', ['nan', '-inf', '1e999', '1e-999', '', '1..2', '1m'], REAL),
    (RUN, '--every', ['0', '-5', '2.5'], COUNT_1),
    (RUN, '--columns', ['0', '1000001'], 'from 1 to 1000000'),
    (RUN, '--arithmetic', ['fast'], 'one of library, stages'),
    (RUN, '--envelope', ['/dev/stdout'], 'another file'),
    (ENERGY, '--dt', ['nan', '0', '-0.01'], POSITIVE),
    (ENERGY, '--duration', ['0.5'], 'at least 1 s'),
    (ORDER, '--n-min --n-max --n-step', ['0', '9007199254740993'], COUNT_53),
    (ORDER, '--match-error', ['0'], POSITIVE),
    (ORDER, '--match-error', ['2', '3'], 'less than 2'),
    (STABILITY, '--points', ['0', '10001', '-3', 'x'], 'from 1 to 10000'),
    (ROUNDING, '--steps', ['9999'], 'from 10000'),
    (SCENE, '--scene', ['', 'ropes', 'Rope'], SCENE_NAME),
    (SCENE, '--method', ['exact'], SCENE_STEPPER),
    (SCENE, '--size', ['1', '4001', '2.5'], 'from 2 to 4000'),
    (SCENE, '--dt --duration --length --mass --fps --stretch --push-duration', ['0', '-1', 'nan'], POSITIVE),
    (SCENE, '--stiffness --damping --drag --rain', ['-1', 'inf'], NOT_NEGATIVE),
    (SCENE, '--poke', ['', '0,1,0,1', '0,1,0,1,1,1', '0,1,0,1,', ',0,1,0,1', '0 1 0 1 1', '0,1,0,1,nan',
                         '0,,0,1,1'], POKE),
    (SCENE, '--drop-box', ['1'], '2 finite numbers separated by commas, T,MASS'),
    (SCENE, '--frames', [''], 'the name of a folder'),
    (MAP, '--method', ['exact'], SCENE_STEPPER),
    (MAP, '--scene', ['sea'], SCENE_NAME),
]

REFUSED = [  # a tool with arguments; what else the message says
    *[([tool, *SHORT[tool], name, value], [name, f'"{value}"', wanted])
      for tool, names, values, wanted in REFUSED_VALUES for name in names.split() for value in values],
    *[([tool, *SHORT[tool], word], [f'"{word}"', 'not an option', f'{tool} --help'])
      for tool in SHORT for word in NOT_AN_OPTION],
    *[([tool, *SHORT[tool], '-o'], ['--output', 'value is missing', 'the name of a file']) for tool in SHORT],
    *[([tool, *SHORT[tool], '--help=1'], ['--help', '"1"', 'takes no value']) for tool in SHORT],
    *[([tool], ['--method', 'missing', METHOD]) for tool in BY_METHOD],
    *[([tool, '--method'], ['--method', 'value is missing', METHOD]) for tool in BY_METHOD],
    *[([tool, *SHORT[tool], '--method', 'euler', '--arithmetic', 'stages'],
       ['--arithmetic', '"stages"', 'rk4', 'should be library']) for tool in BY_METHOD],
    *[([VALIDATE, '--case', name], ['--case', f'"{name}"', 'one of', 'turning-point', 'billion-steps'])
      for name in ('nothing', '', 'middl', 'Middle')],
    *[([SCENE, *SHORT[SCENE], '--poke', f'0,{at},1,1'],
       ['--poke', f'"{at}"', 'X should be from 0 to 2', 'Y from 0 to 0']) for at in ('2.1,0', '-0.1,0', '1,0.5')],
    *[([SCENE, *SHORT[SCENE], '--scene', scene, '--gravity', '1'], ['--gravity', '"1"', scene])
      for scene in ('chain', 'water')],
    *[([SCENE, *SHORT[SCENE], '--scene', scene, '--end-mass', '1'], ['--end-mass', '"1"', scene])
      for scene in ('cloth', 'jelly', 'chain', 'water')],
    *[([tool, *SHORT[tool], *words.split()], wanted) for tool, words, wanted in [
        (RUN, '--mass 1e-300 --stiffness 1e300', ['--mass', '"1e-300"', 'finite']),
        (RUN, '--duration 1e-320 --steps 1e10', ['--duration', 'larger']),
        (RUN, '--envelope x -o x', ['--envelope', '"x"', 'another file']),
        (RUN, '--envelope ./x -o x', ['--envelope', '"./x"', 'another file']),
        (ENERGY, '--method rk4 --duration 1e30', ['a run of 1e+30 s', '2^53 steps of 0.01 s', 'at most 9.0072e+13 s']),
        (ENERGY, '--method rk4 --half-step-velocity', ['--half-step-velocity', 'rk4', 'should be leapfrog']),
        (ENERGY, '--half-step-velocity=1', ['--half-step-velocity', '"1"', 'no value']),
        (ORDER, '--method exact --fit', ['--method', '"exact"', *STEPPERS]),
        (ORDER, '--method exact --match-error 1', ['--method', '"exact"', *STEPPERS]),
        (ORDER, '--method rk4 --fit --match-error 1', ['--fit', '--match-error']),
        (ORDER, '--method rk4 --n-max 4', ['--n-max', '"4"', 'at least --n-min', '5']),
        (ORDER, '--method rk4 --fit --n-max 9', ['--fit', '--n-max']),
        (ROUNDING, '--method euler --sum compensated', ['--sum', '"compensated"', 'leapfrog and rk4', 'plain']),
        (SCENE, '--method rkn8 --damping 0.1', ['--method', '"rkn8"', 'damped']),
        (SCENE, '--poke -1,1,0,1,1', ['--poke', '"-1"', 'at least 0 s']),
        (SCENE, '--poke 0,1,0,1,0', ['--poke', '"0"', 'greater than 0']),
        (SCENE, '--drop-box -1,1', ['--drop-box', '"-1"', 'at least 0 s']),
        (SCENE, '--poke 0.1,1,0,1,1', ['--poke', '"0.1"', 'below 0.1 s']),
        (SCENE, '--drop-box 7,1', ['--drop-box', '"7"', 'below 0.1 s']),
        (SCENE, '--drop-box 0,0', ['--drop-box', '"0"', 'greater than 0 kg']),
        (SCENE, '--rain 1e7', ['--rain', '"1e+07"', 'at most 1e+06']),
        (SCENE, '--steps-per-frame 2 --dt 0.1', ['--steps-per-frame', '"2"', '--dt']),
        (SCENE, '--steps-per-frame 2 --steps 9', ['--steps-per-frame', '"2"', '--steps and --duration']),
        (SCENE, '--dt 0.1 --steps 1', ['--dt, --steps, --duration', 'not three']),
        (SCENE, '--links all', ['--links', '"all"', 'rope has only structural links']),
        (SCENE, '--scene chain --links structural', ['--links', '"structural"', 'chain has only structural links']),
        (SCENE, '--seed 1', ['--seed', 'without --rain']),
        (SCENE, '--rain 1 --seed 99999999999999999999', ['--seed', '"99999999999999999999"', 'at least 0']),
        (SCENE, '--push-duration 0.1', ['--push-duration', '"0.1"', '--poke', '--rain', '--drop-box']),
        (SCENE, '--poke 0,1,0,1,1 ' * 101, ['--poke', '"0,1,0,1,1"', 'one too many', '100 times']),
        (SCENE, '--poke 0,1,0,1,1 --poke 0,3,0,1,1', ['--poke', '"3,0"', 'X should be from 0 to 2']),
        (SCENE, '--drop-box 0,1 --drop-box 0,-1', ['--drop-box', '"-1"', 'greater than 0 kg']),
        (RUN, '--dt 0.1', ['--dt, --steps, --duration', 'not three']),
        (ENERGY, '--dt 0.1 --steps 100', ['--dt, --steps, --duration', 'not three']),
        (ROUNDING, '--dt 0.1 --duration 2000', ['--dt, --steps, --duration', 'not three']),
        (SCENE, '--frame-rate 50', ['--frame-rate', 'without --steps-per-frame']),
        (SCENE, '--axes 3', ['--axes', '"3"', 'for water', 'rope it should be 2']),
        (SCENE, '--scene water --axes 2', ['--axes', '"2"', '1 or 3']),
        (SCENE, '--scene water --stretch 1', ['--stretch', '"1"', 'greater than 1']),
        (SCENE, '--scene jelly --size 4000', ['--size', '"4000"', 'more particles or links']),
        *[(SCENE, f'--{name} {value} --dt 1', [f'--{name}', f'"{shown}"', 'should be finite'])
          for name, value, shown in [('mass', '1e-310', '1e-310'), ('stiffness', '1e308', '1e+308'), ('damping', '1e308', '1e+308'),
                                     ('drag', '1e308', '1e+308'), ('tethers', '1e308', '1e+308')]],
        *[(SCENE, f'--scene chain {words}', [f'{words.split()[0]}: ', 'not for scenes with one axis', *words.split()[1:]])
          for words in ('--tear 2.5', '--tethers 0.25', '--tension-only')],
        (SCENE, '--fps 1e-320', ['--fps: "9.9', 'step of 0 s']),
        (SCENE, '--drop-box 0,1 --push-duration 1e-310', ['--push-duration: "1e-310"', 'step of 0 s']),
        (SCENE, '--frame-rate 1e308 --steps-per-frame 4', ['--frame-rate: "1e+308"', '"4"', 'step of 0 s']),
        (SCENE, '--duration 1e4 --dt 1e-13', ['--dt', '"1e-13"', '2^53 steps', 'at least 1.1']),
        (SCENE, '--duration 1e5', ['--duration: a run of "100000" s', '1e+06 frames', '60 per second', 'below 16666.7 s']),
        (SCENE, '--duration 1e5 --fps 60', ['--fps', '"60"', '1e+06 frames', 'below 10']),
        (SCENE, '--mass 1e-300', ['a run of 0.1 s', '2^53 steps of 1.1']),
        (SCENE, '--fps 1e300', ['--fps', '"1e+300"', 'below 1e+07']),
    ]],
    *[(words.split(), wanted) for words, wanted in [
        (f'{RUN} --method euler --duration 1', ['--dt, --steps, --duration', 'two of them']),
        (f'{RUN} --method euler --steps 1', ['--dt, --steps, --duration', 'two of them']),
        (f'{RUN} --method euler --duration 1 --steps 0 --steps 10', ['--steps', '"0"', COUNT_53]),
        (f'{RUN} --method euler --dt 1', ['--dt, --steps, --duration', 'two of them']),
        (f'{RUN} --method euler --dt 1e-9 --duration 1e9', ['--dt', '"1e-09"', '2^53 steps', 'at least 1.1']),
        (f'{RUN} --method euler --dt 1e300 --steps 1e10', ['--dt', '"1e+300"', '10000000000 steps', 'finite']),
        (f'{VALIDATE} --case', ['--case', 'value is missing', 'one of']),
        (f'{ROUNDING} --method rk4', ['--sum', 'missing', 'one of plain, compensated']),
        (f'{ROUNDING} --method rk4 --sum plain --dt 1e-3 --duration 1', ['--duration', '"1"', '1000 steps', 'at least 10000 of them, 10 s']),
        (f'{SCENE} --scene rope', ['--method', 'missing', SCENE_STEPPER]),
        (f'{SCENE} --scene rope --method rk4 --steps 100', ['--steps', '"100"', '--dt, --steps-per-frame or --duration']),
        (f'{SCENE} --scene rope --method rk4 --frame-rate 1e-300 --steps-per-frame 1 --steps 1e10',
         ['--steps', '"10000000000"', '1e+300 s', 'finite']),
        (f'{SCENE} --method rk4', ['--scene', 'missing', 'rope']),
        (f'{PLAN} --duration 1 --hertz 1', ['--error', 'missing', 'such as 0.01']),
        (f'{PLAN} --error 0.1 --hertz 1', ['--duration', 'missing', 'seconds']),
        (f'{PLAN} --error 0.1 --duration 1', ['--stiffness', '--hertz', '--scene']),
        (f'{PLAN} --error 0.1 --duration 1 --hertz 1 --stiffness 1', ['--stiffness', '--hertz', '--scene']),
        (f'{PLAN} --error 0.1 --duration 1 --hertz 1 --damping 1', ['--damping', '"1"', '--damping-ratio']),
        (f'{PLAN} --error 0.1 --duration 1 --hertz 1 --mass 2', ['--mass', '"2"', 'no effect']),
        (f'{PLAN} --error 0.1 --duration 1 --stiffness 1 --damping-ratio 1', ['--damping-ratio', '"1"', '--damping']),
        (f'{PLAN} --error 0.1 --duration 1 --stiffness 1 --drag 1', ['--drag', '"1"', '--damping']),
        (f'{PLAN} --error 0.1 --duration 1 --stiffness 1 --size 9', ['--size', '"9"', 'for a scene']),
        (f'{PLAN} --error 0.1 --duration 1 --scene rope --hertz 1', ['--hertz', '"1"', 'one spring']),
        (f'{PLAN} --error 0.1 --duration 1 --mesh a.obj', ['--stiffness', 'missing']),
        (f'{PLAN} --error 0.1 --duration 1 --mesh a.obj --scene rope', ['--mesh', '"a.obj"', '--scene']),
        (f'{PLAN} --error 0.1 --duration 1 --mesh a.obj --stiffness 1 --size 9', ['--size', '"9"', '--scene']),
        (f'{PLAN} --error 0 --duration 1 --hertz 1', ['--error', '"0"', POSITIVE]),
        (f'{PLAN} --error 0.1 --duration 1 --stiffness 1e308 --mass 1e-3', ['--mass: "0.001"', 'stiffness/mass', 'finite']),
        *[(f'{PLAN} --error 0.1 --duration 1 --hertz {value}', [f'--hertz: "{shown}"', 'too large or too small'])
          for value, shown in [('1e300', '1e+300'), ('1e-170', '1e-170')]],
        (f'{PLAN} --error 0.1 --duration 1 --hertz 1 --damping-ratio 1e308', ['--damping-ratio: "1e+308"', 'too large']),
        *[(f'{PLAN} --presets --{name} 3', [f'--{name}', '"3"', 'not for --presets'])
          for name in ('size', 'mass', 'damping', 'damping-ratio', 'drag')],
        (f'{PLAN} --error 0.1 --duration 1 --hertz 1 --quick', ['--quick', 'without --presets']),
        (f'{MAP} --map runs.tsv', ['--map', '"runs.tsv"', 'without --time']),
        (f'{RUN} --method rk4 --dt 1 --steps 9 --columns 3', ['--columns', 'without --envelope']),
        (f'{RUN} --method rk4 --dt 1 --steps 9 --from 3', ['--from', 'without --every']),
        (f'{VALIDATE} --list --case fast-root', ['--case', 'no effect with --list']),
        (f'{VALIDATE} --list --quick', ['--quick', 'no effect with --list']),
        (f'{PLAN} --presets --error 0.1', ['--error', '"0.1"', '--presets']),
        (f'{WORK} --problem ideal-2', ['--problem', '"ideal-2"', 'ideal-10000']),
        (f'{BENCH} --part spring --kernel leapfrog_batch_1', ['no row', '--part, --kernel']),
        (f'{BENCH} --part scenery', ['--part', '"scenery"', 'batch']),
    ]],
]


@pytest.mark.parametrize('command, wanted', [pytest.param(*case, id=shlex.join(case[0])) for case in REFUSED])
def test_refused(command, wanted):
    is_failure(run(*command), 2, *wanted)


def test_methods():
    assert {'euler', 'leapfrog', 'rk4', 'exact'} <= set(METHODS) and len(set(METHODS)) == len(METHODS)


LEAPFROG = ['--method', 'leapfrog', '--duration', '2']


@pytest.mark.parametrize('args', [
    pytest.param([*LEAPFROG, '--steps', '1e3', '--x0', '-0.25'], id='1e3 for 1000'),
    pytest.param([*LEAPFROG, '--steps', '1000', '--x0', '-0x1p-2'], id='hexadecimal numbers'),
    pytest.param(['--method=leapfrog', '--duration=2', '--steps=1000', '--x0=-.25e0'], id='--option=value'),
    pytest.param([*LEAPFROG, '--steps', '7', '--x0', '3', '--x0', '-0.25', '--steps', '1000'], id='the last counts'),
])
def test_accepted(args):
    assert table(RUN, *args) == table(RUN, *LEAPFROG, '--steps', '1000', '--x0', '-0.25')


@each_tool
def test_help_acts_at_once_and_an_error_before_it_is_an_error(tool):
    assert (run(tool, '--help', '--bogus').returncode, run(tool, '--bogus', '--help').returncode) == (0, 2)


@each_tool
def test_version(tool):
    result = run(tool, '--version')
    assert (result.returncode, result.stderr) == (0, '')
    assert re.fullmatch(tool + r' \(springstep\) \d+\.\d+\.\d+\n', result.stdout)


@each_tool
def test_form_of_a_table(tool):
    lines = run(tool, *SHORT[tool]).stdout.splitlines()
    comments = [line for line in lines if line.startswith('#')]
    assert lines[:len(comments)] == comments
    assert re.fullmatch(rf'# springstep \d+\.\d+\.\d+, {tool}', lines[0])
    assert lines[1] == f'# command: {" ".join([tool, *SHORT[tool]])}'
    if tool != SWEEP:  # whose rows come from many machines, and depend on none
        assert re.fullmatch(r'# compiler: (gcc|clang) \d+\.\d+\.\d+', lines[2])
    if tool in BY_METHOD:
        assert lines[3].startswith('# method: ')
    fixed = COLUMNS[tool].split()
    assert lines[len(comments)].split('\t')[:len(fixed)] == fixed
    numbers = [field for line in lines[len(comments) + 1:] for field in line.split('\t') if field[0] in '-.0123456789']
    assert ['%.17g' % float(number) for number in numbers] == numbers


PROGRESS = ['--method', 'rk4', '--duration', '1e5']


def test_no_progress_into_a_file():
    assert run(ENERGY, *PROGRESS).stderr == ''


def test_progress_on_a_terminal(terminal):
    result = run(ENERGY, *PROGRESS, stderr=terminal[1])
    assert result.returncode == 0
    assert re.search(r'\rspring-energy: +\d+\.\d %', os.read(terminal[0], 4096).decode())
    assert result.stdout == run(ENERGY, *PROGRESS).stdout


def test_time_left_on_a_terminal(terminal):
    """As soon as there is an estimate, and none before."""
    seen, patience = '', time.monotonic() + 60
    with subprocess.Popen([ENERGY, '--method', 'rk4'], stdout=subprocess.DEVNULL, stderr=terminal[1]) as process:
        while 'left' not in seen and time.monotonic() < patience:
            seen += os.read(terminal[0], 4096).decode()
        process.terminate()
    assert re.match(r'\rspring-energy: +0\.0 % +\r', seen)
    assert re.search(r'\rspring-energy: +\d+\.\d %, [1-9]\d* (s|min) left +', seen), seen


def test_rows_begin_on_a_line_of_their_own(terminal):
    run(ENERGY, *PROGRESS, stdout=terminal[1], stderr=terminal[1])
    shown = os.read(terminal[0], 4096).decode().replace('\r\n', '\n').split('\n')
    assert all(re.match('$|#|method|rk4', line.rpartition('\r')[2]) for line in shown), shown
