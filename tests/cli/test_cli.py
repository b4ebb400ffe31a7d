# SPDX-License-Identifier: MIT
"""The command-line tools as their users see them: numbers, columns, messages, exit statuses, files. Prints TAP.

Usage: test_cli.py PATH/spring-order PATH/spring-run PATH/spring-energy PATH/spring-validate PATH/spring-stability
                   PATH/spring-rounding PATH/spring-scene PATH/spring-scene-map PATH/spring-bench PATH/spring-work
"""
import math
import os
import pty
import re
import signal
import stat
import subprocess
import sys
import time

from tap import PATHS, check, column, equal, in_shell, parse, run, run_tests, table

BENCH, WORK = TIMING = 'spring-bench', 'spring-work'  # measure time: no two runs give the same bytes
TOOLS = {name: path for name, path in PATHS.items() if name not in TIMING}
ORDER, RUN, ENERGY = BY_METHOD = 'spring-order', 'spring-run', 'spring-energy'  # these have --method, --arithmetic
VALIDATE, STABILITY, ROUNDING = 'spring-validate', 'spring-stability', 'spring-rounding'
SCENE, MAP = 'spring-scene', 'spring-scene-map'
SEED_RUN = ['--duration', '1000', '--steps', '1e7']
SHORT = {  # for every tool a run that takes no time
    ORDER: ['--method', 'euler', '--n-max', '50'],
    RUN: ['--method', 'rk4', '--duration', '3', '--steps', '30', '--every', '1'],
    ENERGY: ['--method', 'leapfrog', '--duration', '10'],
    VALIDATE: ['--case', 'fast-root'],
    STABILITY: ['--map', '--points', '2'],
    ROUNDING: ['--method', 'rk4', '--sum', 'plain', '--steps', '1e4'],
    SCENE: ['--scene', 'rope', '--method', 'leapfrog', '--duration', '0.1'],
    MAP: ['--scene', 'chain', '--method', 'rk4', '--quick'],
}
COLUMNS = {  # the fixed ones, in their order; others may follow
    ORDER: 'method n dt_s error_m',
    RUN: 'method step t_s x_m v_m_per_s energy_J exact_x_m error_m',
    ENERGY: 'method velocity duration_s steps energy_error_J',
    VALIDATE: 'case method witness dt_s steps error bound verdict',
    STABILITY: 'method omega_dt damping_ratio error',  # of --map
    ROUNDING: 'method sum start steps dt_s state_error energy_error',
    SCENE: 't_s energy_J kinetic_J elastic_J gravity_J max_displacement_m',
    MAP: 'scene method particles links substeps dt_s stable_step_s energy_error verdict',
}


def describe(tool, args):
    return ' '.join([tool, *(argument or "''" for argument in args)])


# --- usage ----------------------------------------------------------------------------------------------------------

def test_bad_usage():
    methods = 'one of euler, leapfrog, rk4, exact'
    count_1, count_53 = 'a whole number of at least 1', 'a whole number from 1 to 9007199254740992'
    positive = 'a finite number greater than 0'
    run_3 = ['--method', 'euler', '--duration', '1', '--steps', '10']
    cases = [  # tool, arguments, what the message has to say
        *[(tool, ['--method', word], ['--method', f'"{word}"', methods])
          for tool in BY_METHOD for word in ('foo', '', 'Euler', 'eul', 'euler ')],
        *[(tool, [], ['--method', 'missing', methods]) for tool in BY_METHOD],
        *[(tool, ['--method'], ['--method', 'value is missing', methods]) for tool in BY_METHOD],
        *[(tool, [*SHORT[tool], word], [f'"{word}"', 'not an option', f'{tool} --help'])
          for tool in TOOLS for word in ('foo', '', '-', '--', '-x', '-output', '-output=x', '--bogus', '--bogus=1', '--meth', '--outpu', '--vers',
                                         '-help')],
        *[(tool, [*SHORT[tool], '--output', ''], ['--output', '""', 'the name of a file']) for tool in TOOLS],
        *[(tool, [*SHORT[tool], '-o'], ['--output', 'value is missing', 'the name of a file']) for tool in TOOLS],
        *[(tool, [*SHORT[tool], '--help=1'], ['--help', '"1"', 'takes no value']) for tool in TOOLS],
        *[(RUN, [*run_3, '--steps', n], ['--steps', f'"{n}"', count_53])
          for n in ('0', '9007199254740993', '-1', '+1', '', ' 1', '1 ', '1.5', '0x10', 'ten', '1e', '1e-1', '1e20', '2e19', '18446744073709551616',
                    '1e99999999999999999999', 'nan', 'inf')],
        *[(RUN, [*run_3, '--duration', t], ['--duration', f'"{t}"', positive])
          for t in ('0', '-1', '', ' 1', '1 ', '1s', '1e999', '-1e999', '1e-999', 'nan', 'inf', '1,5', '1e', '.')],
        *[(RUN, [*run_3, '--mass', m], ['--mass', f'"{m}"', positive]) for m in ('-1', '0', '-0', 'nan', '1e999')],
        *[(RUN, [*run_3, option, value], [option, f'"{value}"', 'a finite number of at least 0'])
          for option in ('--stiffness', '--damping') for value in ('-1', '', 'nan', 'infinity', '1e999')],
        *[(RUN, [*run_3, option, value], [option, f'"{value}"', 'a finite number'])
          for option in ('--load', '--x0', '--v0', '--from') for value in ('nan', '-inf', '1e999', '1e-999', '', '1..2', '1m')],
        *[(RUN, [*run_3, '--every', k], ['--every', f'"{k}"', count_1]) for k in ('0', '-5', '2.5')],
        (RUN, [*run_3, '--columns', '0'], ['--columns', '"0"', 'from 1 to 1000000']),
        (RUN, [*run_3, '--columns', '1000001'], ['--columns', '"1000001"', 'from 1 to 1000000']),
        (RUN, [*run_3, '--mass', '1e-300', '--stiffness', '1e300'], ['--mass', '"1e-300"', 'finite']),
        (RUN, [*run_3, '--duration', '1e-320', '--steps', '1e10'], ['--duration', 'larger']),
        (RUN, [*run_3, '--arithmetic', 'fast'], ['--arithmetic', '"fast"', 'one of library, stages']),
        *[(tool, [*SHORT[tool], '--method', 'euler', '--arithmetic', 'stages'],
           ['--arithmetic', '"stages"', 'rk4', 'should be library']) for tool in BY_METHOD],
        (RUN, ['--method', 'euler', '--duration', '1'], ['--steps', 'missing', count_53]),
        (RUN, ['--method', 'euler', '--steps', '1'], ['--duration', 'missing', positive]),
        (RUN, [*run_3, '--envelope', 'x', '-o', 'x'], ['--envelope', '"x"', 'another file']),
        (RUN, [*run_3, '--envelope', './x', '-o', 'x'], ['--envelope', '"./x"', '--output', 'another file']),
        (RUN, [*run_3, '--envelope', '/dev/stdout'], ['--envelope', '"/dev/stdout"', 'another file']),
        *[(ENERGY, ['--method', 'rk4', '--dt', dt], ['--dt', f'"{dt}"', positive]) for dt in ('nan', '0', '-0.01')],
        (ENERGY, ['--method', 'rk4', '--duration', '0.5'], ['--duration', '"0.5"', 'at least 1 s']),
        (ENERGY, ['--method', 'rk4', '--duration', '1e30'], ['--duration', '"1e+30"', 'at most']),
        (ENERGY, ['--method', 'rk4', '--half-step-velocity'], ['--half-step-velocity', 'rk4', 'should be leapfrog']),
        (ENERGY, ['--method', 'leapfrog', '--half-step-velocity=1'], ['--half-step-velocity', '"1"', 'no value']),
        (ORDER, ['--method', 'exact', '--fit'], ['--method', '"exact"', 'euler, leapfrog or rk4']),
        (ORDER, ['--method', 'exact', '--match-error', '1'], ['--method', '"exact"', 'euler, leapfrog or rk4']),
        (ORDER, ['--method', 'rk4', '--fit', '--match-error', '1'], ['--fit', '--match-error']),
        *[(ORDER, ['--method', 'rk4', option, n], [option, f'"{n}"', count_53])
          for option in ('--n-min', '--n-max', '--n-step') for n in ('0', '9007199254740993')],
        (ORDER, ['--method', 'rk4', '--n-max', '4'], ['--n-max', '"4"', 'at least --n-min', '5']),
        (ORDER, ['--method', 'rk4', '--fit', '--n-max', '9'], ['--fit', '--n-max']),
        (ORDER, ['--method', 'rk4', '--match-error', '0'], ['--match-error', '"0"', positive]),
        *[(VALIDATE, ['--case', name], ['--case', f'"{name}"', 'one of', 'turning-point', 'billion-steps'])
          for name in ('nothing', '', 'middl', 'Middle')],
        (VALIDATE, ['--case'], ['--case', 'value is missing', 'one of']),
        *[(STABILITY, ['--points', n], ['--points', f'"{n}"', 'from 1 to 10000']) for n in ('0', '10001', '-3', 'x')],
        (ROUNDING, ['--method', 'rk4'], ['--sum', 'missing', 'one of plain, compensated']),
        (ROUNDING, ['--sum', 'plain', '--method', 'euler'], ['--method', '"euler"', 'one of leapfrog, rk4']),
        (ROUNDING, [*SHORT[ROUNDING], '--steps', '9999'], ['--steps', '"9999"', 'from 10000']),
        *[(SCENE, [*SHORT[SCENE], '--scene', name], ['--scene', f'"{name}"', 'one of rope, cloth, jelly, chain, water'])
          for name in ('', 'ropes', 'Rope')],
        (SCENE, ['--scene', 'rope'], ['--method', 'missing', 'euler, leapfrog, rk4']),
        (SCENE, ['--method', 'rk4'], ['--scene', 'missing', 'rope']),
        (SCENE, [*SHORT[SCENE], '--method', 'exact'], ['--method', '"exact"', 'one of euler, leapfrog, rk4']),
        *[(SCENE, [*SHORT[SCENE], '--size', n], ['--size', f'"{n}"', 'from 2 to 4000']) for n in ('1', '4001', '2.5')],
        *[(SCENE, [*SHORT[SCENE], option, x], [option, f'"{x}"', positive])
          for option in ('--dt', '--duration', '--length', '--mass', '--fps', '--stretch', '--push-duration') for x in ('0', '-1', 'nan')],
        *[(SCENE, [*SHORT[SCENE], option, x], [option, f'"{x}"', 'a finite number of at least 0'])
          for option in ('--stiffness', '--damping', '--drag', '--rain') for x in ('-1', 'inf')],
        *[(SCENE, [*SHORT[SCENE], '--poke', x], ['--poke', f'"{x}"', '5 finite numbers', 'T,X,Y,FORCE,AREA'])
          for x in ('', '0,1,0,1', '0,1,0,1,1,1', '0,1,0,1,', ',0,1,0,1', '0 1 0 1 1', '0,1,0,1,nan', '0,,0,1,1')],
        (SCENE, [*SHORT[SCENE], '--poke', '-1,1,0,1,1'], ['--poke', '"-1"', 'at least 0 s']),
        (SCENE, [*SHORT[SCENE], '--poke', '0,1,0,1,0'], ['--poke', '"0"', 'greater than 0']),
        *[(SCENE, [*SHORT[SCENE], '--poke', f'0,{at},1,1'], ['--poke', f'"{at}"', 'X should be from 0 to 2', 'Y from 0 to 0'])
          for at in ('2.1,0', '-0.1,0', '1,0.5')],
        (SCENE, [*SHORT[SCENE], '--drop-box', '1'], ['--drop-box', '"1"', '2 finite numbers', 'T,MASS']),
        (SCENE, [*SHORT[SCENE], '--drop-box', '-1,1'], ['--drop-box', '"-1"', 'at least 0 s']),
        (SCENE, [*SHORT[SCENE], '--drop-box', '0,0'], ['--drop-box', '"0"', 'greater than 0 kg']),
        (SCENE, [*SHORT[SCENE], '--rain', '1e7'], ['--rain', '"1e+07"', 'at most 1e+06']),
        (SCENE, [*SHORT[SCENE], '--axes', '3'], ['--axes', '"3"', 'for water', 'rope it should be 2']),
        (SCENE, [*SHORT[SCENE], '--scene', 'water', '--axes', '2'], ['--axes', '"2"', '1 or 3']),
        (SCENE, [*SHORT[SCENE], '--scene', 'water', '--stretch', '1'], ['--stretch', '"1"', 'greater than 1']),
        *[(SCENE, [*SHORT[SCENE], '--scene', name, '--gravity', '1'], ['--gravity', '"1"', name]) for name in ('chain', 'water')],
        *[(SCENE, [*SHORT[SCENE], '--scene', name, '--end-mass', '1'], ['--end-mass', '"1"', name])
          for name in ('cloth', 'jelly', 'chain', 'water')],
        (SCENE, [*SHORT[SCENE], '--scene', 'jelly', '--size', '4000'], ['--size', '"4000"', 'more particles or links']),
        (SCENE, [*SHORT[SCENE], '--mass', '1e-320', '--dt', '1'], ['mass', 'not valid', 'should be finite']),
        (SCENE, [*SHORT[SCENE], '--duration', '1e4', '--dt', '1e-13'], ['--dt', '"1e-13"', '2^53 steps', 'at least 1.1']),
        (SCENE, [*SHORT[SCENE], '--duration', '1e5'], ['--fps', '"60"', '1e+06 frames', 'below 10']),
        (SCENE, [*SHORT[SCENE], '--fps', '1e300'], ['--fps', '"1e+300"', 'below 1e+07']),
        (SCENE, [*SHORT[SCENE], '--frames', ''], ['--frames', '""', 'the name of a folder']),
        (MAP, ['--method', 'exact'], ['--method', '"exact"', 'one of euler, leapfrog, rk4']),
        (MAP, ['--scene', 'sea'], ['--scene', '"sea"', 'one of rope']),
    ]
    for tool, args, needles in cases:
        result = run(tool, *args)
        lines = result.stderr.splitlines()
        check(result.returncode == 2 and result.stdout == '' and len(lines) == 1 and lines[0].startswith(f'{tool}: ')
              and all(needle in lines[0] for needle in needles),
              f'refused: {describe(tool, args)}', f'status {result.returncode}\n{result.stdout}{result.stderr}{needles}')


def test_spellings():
    base = ['--method', 'leapfrog', '--duration', '2']
    want = table(RUN, *base, '--steps', '1000', '--x0', '-0.25')
    for name, args in {
        '1e3 for 1000': [*base, '--steps', '1e3', '--x0', '-0.25'],
        'hexadecimal numbers': [*base, '--steps', '1000', '--x0', '-0x1p-2'],
        '--option=value': ['--method=leapfrog', '--duration=2', '--steps=1000', '--x0=-.25e0'],
        'the last of several counts': [*base, '--steps', '7', '--x0', '3', '--x0', '-0.25', '--steps', '1000'],
    }.items():
        equal(table(RUN, *args), want, f'accepted: {name}')
    equal(run(RUN, *base, '--steps', '0', '--steps', '10').returncode, 2, 'every one of several is checked')


def test_help_and_version():
    for tool in TOOLS:
        result = run(tool, '--help')
        check(result.returncode == 0 and result.stderr == '' and result.stdout.startswith(f'Usage: {tool} '),
              f'{tool} --help', result)
        for word in [*(['--method M', '--arithmetic'] if tool in BY_METHOD else []), '--output', '-o', '--help', '--version', 'Exit status',
                     *COLUMNS[tool].split()]:
            check(word in result.stdout, f'{tool} --help explains {word}')
        equal(run(tool, '--bogus', '--help').returncode, 2, f'{tool}: an error before --help is an error')
        equal(run(tool, '--help', '--bogus').returncode, 0, f'{tool}: --help acts at once')
        result = run(tool, '--version')
        check(result.returncode == 0 and result.stderr == ''
              and re.fullmatch(re.escape(tool) + r' \(springstep\) \d+\.\d+\.\d+\n', result.stdout) is not None,
              f'{tool} --version', result)


# --- files ----------------------------------------------------------------------------------------------------------

def test_cannot_write(folder):
    target = os.path.join(folder, 'old.tsv')
    gone, under_file = os.path.join(folder, 'no', 'such'), os.path.join(target, 'x')
    dangling = os.path.join(folder, 'dangling')
    os.symlink(gone, dangling)
    for tool in TOOLS:
        with open(target, 'w', encoding='ascii') as file:
            file.write('older\n')
        for script, what in {'"$@" > /dev/full': 'a full disk', '"$@" >&-': 'a closed output'}.items():
            for args in (SHORT[tool], ['--help'], ['--version']):
                result = in_shell(script, tool, *args)
                check(result.returncode == 3 and result.stderr.startswith(f'{tool}: cannot write standard output: '),
                      f'{what}: {describe(tool, args)}', result)
        for args in (SHORT[tool], ['--help'], ['--version']):
            reader, writer = os.pipe()
            os.close(reader)
            result = run(tool, *args, stdout=writer)
            os.close(writer)
            check(result.returncode == 3 and result.stderr.startswith(f'{tool}: cannot write standard output: '),
                  f'a closed pipe: {describe(tool, args)}', result)
        for path in ('/dev/full', gone, under_file, folder, dangling, 'x' * 300, 'x/' * 3000):
            result = run(tool, *SHORT[tool], '-o', path)
            check(result.returncode == 3 and result.stdout == ''
                  and result.stderr.startswith(f'{tool}: --output: cannot write "{path}": ')
                  and 'should be a file that can be' in result.stderr, f'{tool} cannot write {path[:40]}', result)
        result = in_shell('ulimit -f 0; exec "$@"', tool, *SHORT[tool], '-o', target)
        check(result.returncode == 3 and result.stderr.startswith(f'{tool}: --output: '), f'{tool}: a file size limit',
              result)
        with open(target, encoding='ascii') as file:
            equal(file.read(), 'older\n', f'{tool}: the older file survives')
        equal(sorted(os.listdir(folder)), ['dangling', 'old.tsv'], f'{tool}: nothing is left behind')


def test_cannot_replace(folder):
    """A file that its owner has made read-only; root may write it, so root tries as somebody else."""
    target = os.path.join(folder, 'old.tsv')
    os.chmod(folder, 0o777)
    with open(target, 'w', encoding='ascii') as file:
        file.write('older\n')
    os.chmod(target, 0o444)
    somebody = {'user': 65534, 'group': 65534, 'extra_groups': []} if os.geteuid() == 0 else {}
    try:
        result = run(ORDER, *SHORT[ORDER], '-o', target, **somebody)
    except PermissionError:
        check(True, 'a read-only file # SKIP the tools are in a folder that is closed to others')
        return
    check(result.returncode == 3 and 'Permission denied' in result.stderr, 'a read-only file is not replaced', result)
    with open(target, encoding='ascii') as file:
        equal(file.read(), 'older\n', 'a read-only file stays as it was')


def test_failed_run_leaves_the_older_file(folder):
    target = os.path.join(folder, 'rows.tsv')
    with open(target, 'w', encoding='ascii') as file:
        file.write('older\n')
    overflow = ['--method', 'euler', '--duration', '1e6', '--steps', '1000', '--every', '1']
    result = run(RUN, *overflow, '-o', target, '--envelope', os.path.join(folder, 'new.tsv'))
    equal(result.returncode, 1, 'a run that overflows has status 1')
    with open(target, encoding='ascii') as file:
        equal(file.read(), 'older\n', 'a run that overflows leaves the older file')
    equal(os.listdir(folder), ['rows.tsv'], 'and no partial file')
    result = run(RUN, *overflow, '-o', 'x' * 300)
    equal(result.returncode, 3, 'a file that cannot be created is noticed before the run')
    result = run(RUN, *SHORT[RUN], '-o', target, '--envelope', '/dev/full')
    check(result.returncode == 3 and '--envelope' in result.stderr, 'an envelope that cannot be written', result)
    with open(target, encoding='ascii') as file:
        equal(file.read(), 'older\n', 'keeps the rows from their place, too')


def test_signals(folder):
    target = os.path.join(folder, 'rows.tsv')
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        with open(target, 'w', encoding='ascii') as file:
            file.write('older\n')
        with subprocess.Popen([TOOLS[ENERGY], '--method', 'rk4', '--duration', '1e9', '-o', target],
                              preexec_fn=lambda n=number: signal.signal(n, signal.SIG_DFL)) as process:
            patience = time.monotonic() + 20
            while len(os.listdir(folder)) < 2 and time.monotonic() < patience:
                time.sleep(0.01)
            begun = len(os.listdir(folder))
            process.send_signal(number)
            equal((begun, process.wait(20)), (2, -number), f'{number.name} ends a run')
        with open(target, encoding='ascii') as file:
            equal((file.read(), os.listdir(folder)), ('older\n', ['rows.tsv']), f'{number.name} leaves the older file alone')


def test_output(folder):
    target, link = os.path.join(folder, 'rows.tsv'), os.path.join(folder, 'link.tsv')
    for tool in TOOLS:
        want = run(tool, *SHORT[tool]).stdout
        equal(run(tool, *SHORT[tool]).stdout, want, f'{tool}: two runs, the same bytes')
        equal(run(tool, *SHORT[tool], executable=TOOLS[tool], cwd='/', env={}).stdout, want,
              f'{tool}: the same bytes from another place')
        renamed = subprocess.run(['/elsewhere/other-name', *SHORT[tool]], executable=TOOLS[tool], capture_output=True,
                                 text=True, check=False)
        equal(renamed.stdout, want, f'{tool}: the same bytes under another name')
        equal(run(tool, *SHORT[tool], '-o', '/dev/stdout').stdout, want, f'{tool} -o /dev/stdout')
        for spelling in (['-o', target], ['-o' + target], ['--output', target], ['--output=' + target]):
            if os.path.exists(target):
                os.remove(target)
            result = run(tool, *SHORT[tool], *spelling)
            with open(target, encoding='ascii') as file:
                equal((result.returncode, result.stdout, file.read()), (0, '', want), f'{tool} {spelling[0][:8]}: the same bytes')
        os.chmod(target, 0o640)
        if not os.path.islink(link):
            os.symlink('rows.tsv', link)
        with open(target, 'w', encoding='ascii') as file:
            file.write('older\n')
        run(tool, *SHORT[tool], '-o', link)
        with open(target, encoding='ascii') as file:
            equal((os.path.islink(link), file.read()), (True, want), f'{tool}: a link is followed and stays a link')
        equal(stat.S_IMODE(os.stat(target).st_mode), 0o640, f'{tool}: a replaced file keeps its mode')
        equal(sorted(os.listdir(folder)), ['link.tsv', 'rows.tsv'], f'{tool}: nothing is left behind')
        os.remove(target)
        result = in_shell('umask 027; exec "$@"', tool, *SHORT[tool], '-o', target)
        equal((result.returncode, stat.S_IMODE(os.stat(target).st_mode)), (0, 0o640), f'{tool}: a new file follows the umask')
        result = in_shell('exec "$@" 2>&-', tool, *SHORT[tool], '-o', target)
        with open(target, encoding='ascii') as file:
            equal((result.returncode, file.read()), (0, want), f'{tool}: a closed standard error does no harm')
    fifo = os.path.join(folder, 'fifo')
    os.mkfifo(fifo)
    with subprocess.Popen(['cat', fifo], stdout=subprocess.PIPE, text=True) as reader:
        run(ORDER, *SHORT[ORDER], '-o', fifo)
        equal(reader.communicate(timeout=20)[0], run(ORDER, *SHORT[ORDER]).stdout, 'a fifo is written directly')
    with subprocess.Popen(['cat', fifo], stdout=subprocess.PIPE, text=True) as reader:
        result = in_shell('exec "$@" 2>&-', RUN, '--method', 'euler', '--duration', '1e6', '--steps', '1000', '-o', fifo)
        rows = reader.communicate(timeout=20)[0]
        check(result.returncode == 1 and 'infinite' not in rows, 'no message among the rows', rows)
    log = os.path.join(folder, 'log')
    with open(log, 'w', encoding='ascii') as file:
        file.write('older\n')
    in_shell(f'exec "$@" >> "{log}"', ORDER, *SHORT[ORDER], '-o', '/dev/stdout')
    with open(log, encoding='ascii') as file:
        equal(file.read(), 'older\n' + run(ORDER, *SHORT[ORDER]).stdout, '/dev/stdout appends where standard output does')


    inode = os.stat(log).st_ino
    in_shell(f'exec "$@" 3> "{log}"', ORDER, *SHORT[ORDER], '-o', '/dev/fd/3')
    with open(log, encoding='ascii') as file:
        equal((os.stat(log).st_ino, file.read()), (inode, run(ORDER, *SHORT[ORDER]).stdout), '/dev/fd/3 is written directly')


def test_format():
    for tool in TOOLS:
        lines = run(tool, *SHORT[tool]).stdout.splitlines()
        comments = [line for line in lines if line.startswith('#')]
        equal(lines[:len(comments)], comments, f'{tool}: comments come first')
        check(re.fullmatch(rf'# springstep \d+\.\d+\.\d+, {tool}', lines[0]) is not None, f'{tool}: stamp', lines[0])
        equal(lines[1], f'# command: {tool} {" ".join(SHORT[tool])}', f'{tool}: command line')
        check(re.fullmatch(r'# compiler: (gcc|clang) \d+\.\d+\.\d+', lines[2]) is not None, f'{tool}: compiler', lines[2])
        if tool in BY_METHOD:
            check(lines[3].startswith('# method: '), f'{tool}: method', lines[3])
        fixed = COLUMNS[tool].split()
        equal(lines[len(comments)].split('\t')[:len(fixed)], fixed, f'{tool}: fixed columns')
        check(all('%.17g' % float(field) == field for line in lines[len(comments) + 1:] for field in line.split('\t')
                  if field[0] in '-.0123456789'), f'{tool}: numbers have all their digits')


def test_progress():
    """Silent but on a terminal."""
    args = ['--method', 'rk4', '--duration', '1e5']
    equal(run(ENERGY, *args).stderr, '', 'no progress into a file')
    terminal, other_end = pty.openpty()
    result = run(ENERGY, *args, stderr=other_end)
    os.close(other_end)
    shown = os.read(terminal, 4096).decode()
    os.close(terminal)
    check(result.returncode == 0 and re.search(r'\rspring-energy: +\d+\.\d %', shown) is not None, 'progress on a terminal',
          repr(shown))
    equal(result.stdout, run(ENERGY, *args).stdout, 'progress leaves the rows alone')
    terminal, other_end = pty.openpty()
    run(ENERGY, *args, stdout=other_end, stderr=other_end)
    os.close(other_end)
    lines = [line.rpartition('\r')[2] for line in os.read(terminal, 4096).decode().replace('\r\n', '\n').split('\n')]
    os.close(terminal)
    check(all(line == '' or line.startswith(('#', 'method', 'rk4')) for line in lines), 'rows begin on a line of their own', lines)


# --- numbers: spring-order --------------------------------------------------------------------------------------------

def fit_line(rows):
    x, y = [math.log(n) for n in column(rows, 'n')], [math.log(e) for e in column(rows, 'error_m')]
    mx, my = math.fsum(x) / len(x), math.fsum(y) / len(y)
    slope = math.fsum((a - mx) * (b - my) for a, b in zip(x, y)) / math.fsum((a - mx) ** 2 for a in x)
    return math.exp(my - slope * mx), slope


def test_order():
    seed = {  # first row and number of rows of the study, its fits, and the error for n = 10
        'euler': (10, 1000, '0.2764 n^-1.0026', '3.048814e-02', math.cos(1) / 2, 1),
        'leapfrog': (10, 1000, '0.03506 n^-2.0000', '3.510549e-04', math.sin(1) / 24, 1),
        'rk4': (5, 200, '0.006763 n^-3.9949', '6.612487e-07', math.sin(1) / 120, 4),
    }
    for method, (first, points, law, error_10, coefficient, cost) in seed.items():
        how = ['--method', method] + (['--arithmetic', 'stages'] if method == 'rk4' else [])
        rows = table(ORDER, *how)
        equal([row['n'] for row in rows], [str(first * (i + 1)) for i in range(points)], f'{method}: n of the study')
        check(all(row['method'] == method and float(row['dt_s']) == 1 / int(row['n'])
                  and int(row['force_evaluations']) == cost * int(row['n']) for row in rows), f'{method}: dt and cost')
        equal(['%.6e' % float(row['error_m']) for row in rows if row['n'] == '10'], [error_10], f'{method}: error for n = 10')
        fit, = table(ORDER, *how, '--fit')
        equal('%.4g n^%.4f' % (float(fit['coefficient_m']), float(fit['exponent'])), law, f'{method}: power law')
        by_hand = fit_line(rows)
        check(abs(float(fit['coefficient_m']) / by_hand[0] - 1) <= 1e-10 and abs(float(fit['exponent']) - by_hand[1]) <= 1e-11,
              f'{method}: least squares', (fit, by_hand))
        check(0.9998 < float(fit['r_squared']) <= 1 and fit['points'] == str(points), f'{method}: R squared and points', fit)
        check(abs(float(fit['theory_coefficient_m']) - coefficient) <= 1e-16, f'{method}: theory', fit)
    library = table(ORDER, '--method', 'rk4')
    stages = table(ORDER, '--method', 'rk4', '--arithmetic', 'stages')
    difference = max(abs(a - b) for a, b in zip(column(library, 'error_m'), column(stages, 'error_m')))
    check(0 < difference <= 1e-14, 'rk4: the two arithmetics differ by rounding', difference)
    exact = table(ORDER, '--method', 'exact')
    check(len(exact) == 1000 and max(column(exact, 'error_m')) <= 1e-15, 'exact: no error but rounding')
    for method, H, law in (('euler', 2, abs(math.cos(2)) * 2), ('leapfrog', 2, math.sin(2) * 8 / 24),
                           ('rk4', 2, math.sin(2) * 32 / 120)):
        fit, = table(ORDER, '--method', method, '--duration', str(H), '--fit', '--n-min', '100', '--n-max', '400')
        check(abs(float(fit['theory_coefficient_m']) / law - 1) <= 1e-15
              and abs(float(fit['coefficient_m']) / law - 1) <= 0.1, f'{method}: theory for another duration', fit)


def test_match_error():
    for method, n, first in (('leapfrog', '34766', '630'), ('rk4', '3719', '1605')):
        row, = table(ORDER, '--method', method, '--duration', '1000', '--match-error', '2.88367e-2')
        equal((row['n'], row['first_n']), (n, first), f"{method}: as accurate as Euler's 1e7 steps")
    for method, error, most in (('euler', 0.3, 3000), ('leapfrog', 1e-3, 4000), ('rk4', 1e-6, 1500), ('leapfrog', 0.5, 400)):
        row, = table(ORDER, '--method', method, '--duration', '10', '--match-error', str(error))
        errors = {int(r['n']): float(r['error_m']) for r in table(
            ORDER, '--method', method, '--duration', '10', '--n-min', '1', '--n-step', '1', '--n-max', str(most))}
        beyond = max(n for n, e in errors.items() if e > error)
        first = min(n for n, e in errors.items() if e <= error)
        equal((int(row['n']), int(row['first_n'])), (beyond + 1, first), f'{method}: every error up to n = {most} looked at')
        check(float(row['error_m']) == errors[beyond + 1] <= error < errors[beyond] == float(row['previous_error_m'])
              and float(row['match_error_m']) == error, f'{method}: the two errors', row)
    for method, error in (('rk4', '1e-17'), ('leapfrog', '1e-13')):
        result = run(ORDER, '--method', method, '--match-error', error)
        check(result.returncode == 1 and 'rounding' in result.stderr, f'{method}: an error below rounding cannot be matched', result)
    result = run(ORDER, '--method', 'rk4', '--match-error', '1', '--duration', '1e300')
    check(result.returncode == 1 and 'rounding' in result.stderr, 'nor can one after a time beyond all phases', result)


# --- numbers: spring-run ------------------------------------------------------------------------------------------------

def test_long_run():
    for how, error in ((['euler'], '2.88367e-02'), (['leapfrog'], '3.44533e-07'), (['rk4'], '9.76996e-15'),
                       (['rk4', '--arithmetic', 'stages'], '2.39808e-14')):
        row, = table(RUN, '--method', *how, *SEED_RUN)
        equal(('%.5e' % float(row['error_m']), row['step'], row['t_s']), (error, '10000000', '1000'),
              f'{" ".join(how)}: error after 1e7 steps')


M, K, C, F, X0, V0 = 1.3, 2.7, 0.6, 0.9, 0.4, -1.1  # a spring with everything, nothing 1
SPRING = ['--mass', '1.3', '--stiffness', '2.7', '--damping', '0.6', '--load', '0.9', '--x0', '0.4', '--v0', '-1.1']


def true_x(t):
    """Textbook solution of the underdamped spring."""
    b, rest = C / (2 * M), F / K
    nu = math.sqrt(K / M - b * b)
    y = X0 - rest
    return rest + math.exp(-b * t) * (y * math.cos(nu * t) + (V0 + b * y) / nu * math.sin(nu * t))


def euler_step(x, v, h):
    w, g, a = K / M, C / M, F / M
    return x + h * v, v - (h * w * x - h * a + h * g * v)


def rk4_step(x, v, h):
    w, g, a = K / M, C / M, F / M
    def slope(x, v):
        return v, a - w * x - g * v
    k1 = slope(x, v)
    k2 = slope(x + h / 2 * k1[0], v + h / 2 * k1[1])
    k3 = slope(x + h / 2 * k2[0], v + h / 2 * k2[1])
    k4 = slope(x + h * k3[0], v + h * k3[1])
    return (x + h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]), v + h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1]))


def test_run():
    time_and_steps = ['--duration', '7', '--steps', '700']
    dt = 7 / 700
    for how, order in ((['euler'], 1), (['leapfrog'], 2), (['rk4'], 4), (['rk4', '--arithmetic', 'stages'], 4),
                       (['exact'], None)):
        name = ' '.join(how)
        rows = table(RUN, '--method', *how, *SPRING, *time_and_steps, '--every', '1')
        equal([row['step'] for row in rows], [str(i) for i in range(701)], f'{name}: --every 1')
        check(all(float(row['t_s']) == i * dt for i, row in enumerate(rows)), f'{name}: times are not accumulated')
        check(all(abs(e - true_x(i * dt)) <= 1e-14 for i, e in enumerate(column(rows, 'exact_x_m'))), f'{name}: exact_x_m')
        check(all(float(r['error_m']) == abs(float(r['x_m']) - float(r['exact_x_m'])) for r in rows), f'{name}: error_m')
        check(all(abs(float(r['energy_J']) - (M * v * v / 2 + K * x * x / 2 - F * x)) <= 1e-15 for r in rows
                  for x, v in [(float(r['x_m']), float(r['v_m_per_s']))]), f'{name}: energy_J')
        equal(table(RUN, '--method', *how, *SPRING, *time_and_steps)[-1]['step'], '700', f'{name}: the last row is the end')
        largest = max(column(rows, 'error_m'))
        if order is None:
            check(largest <= 700 * 4 * sys.float_info.epsilon, 'exact: at most 4 epsilon a step, of about 1', largest)
            continue
        equal(table(RUN, '--method', *how, *SPRING, *time_and_steps), rows[-1:], f'{name}: without --every only the final state')
        finer = max(column(table(RUN, '--method', *how, *SPRING, '--duration', '7', '--steps', '1400', '--every', '2'), 'error_m'))
        check(abs(math.log2(largest / finer) - order) <= 0.05, f'{name}: order {order}', largest / finer)
    for how, step in ((['euler'], euler_step), (['rk4', '--arithmetic', 'stages'], rk4_step)):
        state, want = (X0, V0), []
        for _ in range(701):
            want.append(state)
            state = step(*state, dt)
        rows = table(RUN, '--method', *how, *SPRING, *time_and_steps, '--every', '1')
        equal(list(zip(column(rows, 'x_m'), column(rows, 'v_m_per_s'))), want, f'{" ".join(how)}: every bit')


def test_rows():
    base = ['--method', 'leapfrog', *SPRING, '--duration', '7', '--steps', '700']
    rows = table(RUN, *base, '--every', '1')
    equal(table(RUN, *base, '--every', '300'), [rows[i] for i in (0, 300, 600, 700)], '--every 300 and the final state')
    equal(table(RUN, *base, '--every', '350'), [rows[i] for i in (0, 350, 700)], '--every 350, the final state once')
    equal(table(RUN, *base, '--every', '1e19'), [rows[0], rows[700]], '--every beyond the end')
    equal([row['step'] for row in table(RUN, '--method', 'euler', '--duration', '1', '--steps', '5e7', '--every', '2e7')],
          ['0', '20000000', '40000000', '50000000'], 'more steps from row to row than are taken at once')
    equal(table(RUN, *base, '--every', '1', '--from', '6.5'), rows[650:], '--from')
    equal(table(RUN, *base, '--every', '1', '--from', '-1'), rows, '--from before the start')
    equal(table(RUN, *base, '--every', '1', '--from', '8'), rows[-1:], '--from beyond the end')
    defaults, = table(RUN, '--method', 'euler', '--duration', '1', '--steps', '10')
    given, = table(RUN, '--method', 'euler', '--duration', '1', '--steps', '10', '--mass', '1', '--stiffness', '1',
                   '--damping', '0', '--load', '0', '--x0', '1', '--v0', '0', '--arithmetic', 'library')
    equal(defaults, given, 'defaults')


def test_envelope(folder):
    path = os.path.join(folder, 'envelope.tsv')
    for steps, parts in ((700, 60), (701, 60), (60, 60), (59, 60), (7, 60), (1, 1)):
        base = ['--method', 'euler', *SPRING, '--duration', '7', '--steps', str(steps), '--every', '1']
        plain = table(RUN, *base)
        rows = table(RUN, *base, '--envelope', path, '--columns', str(parts))
        equal(rows, plain, f'{steps} steps: the envelope leaves the rows alone')
        errors = {}
        for row in plain:
            part = min(int(row['step']) * parts // steps, parts - 1)
            errors.setdefault(part, []).append(float(row['x_m']) - float(row['exact_x_m']))
        with open(path, encoding='ascii') as file:
            text = file.read()
        check(folder not in text and '--envelope FILE' in text, f'{steps} steps: the stamp names no file', text)
        equal(text.splitlines()[4], 'method\tt_s\terror_min_m\terror_max_m', f'{steps} steps: columns of the envelope')
        got = parse(text)
        equal([(float(r['error_min_m']), float(r['error_max_m'])) for r in got], [(min(e), max(e)) for e in errors.values()],
              f'{steps} steps in {parts} parts: minima and maxima')
        check(all(abs(float(r['t_s']) - (part + 0.5) * 7 / parts) <= 1e-14 for r, part in zip(got, errors, strict=True)),
              f'{steps} steps in {parts} parts: times')


def test_overflow():
    h, state, step = 1e6 / 1000, (1.0, 0.0), 0
    while all(map(math.isfinite, state)):
        last = state
        state = (state[0] + h * state[1], state[1] - h * state[0])
        step += 1
    for every in ('1', '7', '1000'):
        result = run(RUN, '--method', 'euler', '--duration', '1e6', '--steps', '1000', '--every', every)
        rows = parse(result.stdout)
        equal((result.returncode, [row['step'] for row in rows]), (1, [str(i) for i in range(0, step, int(every))]),
              f'overflow: rows up to there, --every {every}')
        check(result.stderr.startswith('spring-run: ') and f'step {step},' in result.stderr and f't = {step}000 s' in result.stderr,
              f'overflow: the message names step and time, --every {every}', result.stderr)
    rows = parse(run(RUN, '--method', 'euler', '--duration', '1e6', '--steps', '1000', '--every', '1').stdout)
    equal((float(rows[-1]['x_m']), float(rows[-1]['v_m_per_s'])), last, 'overflow: the last finite state')
    result = run(RUN, '--method', 'rk4', '--arithmetic', 'stages', '--duration', '1e6', '--steps', '1000', '--every', '1')
    check(result.returncode == 1 and len(parse(result.stdout)) > 1, 'overflow by stages', result.returncode)
    result = run(ORDER, '--method', 'rk4', '--n-min', '2000', '--n-max', '4000', '--n-step', '1', '--fit')
    check(result.returncode == 1 and 'the error is 0' in result.stderr, 'no power law through an error of 0', result)
    result = run(ORDER, '--method', 'rk4', '--duration', '1e9', '--n-max', '5000')
    check(result.returncode == 1 and 'steps of' in result.stderr, 'overflow in spring-order', result.stderr)


# --- numbers: spring-energy ---------------------------------------------------------------------------------------------

def test_energy():
    seed = {
        ('euler',): ('5.024831e-03', '5.258270e-02', '8.590730e-01', '1.100723e+04', '1.337355e+43'),
        ('leapfrog', '--half-step-velocity'): ('2.268005e-03', '2.287520e-03', '2.176101e-03', '2.312644e-03', '1.628639e-03'),
        ('leapfrog',): ('8.850965e-06', '3.699963e-06', '3.200530e-06', '8.594982e-06', '1.487909e-06'),
        ('rk4', '--arithmetic', 'stages'): ('6.939449e-13', '6.943834e-12', '6.944789e-11', '6.944327e-10', '6.944331e-09'),
    }
    for how, errors in seed.items():
        rows = table(ENERGY, '--method', *how, '--duration', '1e4')
        equal(tuple('%.6e' % e for e in column(rows, 'energy_error_J')), errors, f'{" ".join(how)}: energy of the study')
        equal([(r['method'], r['duration_s'], r['steps']) for r in rows], [(how[0], str(10 ** i), str(10 ** (i + 2))) for i in range(5)],
              f'{" ".join(how)}: rows')
        velocity = 'half_step_ahead' if '--half-step-velocity' in how else 'synchronised'
        equal({r['velocity'] for r in rows}, {velocity}, f'{" ".join(how)}: velocity')
    equal([r['energy_error_J'] for r in table(ENERGY, '--method', 'euler', '--duration', '1e6')][5:], ['inf', 'inf'],
          'an energy that overflows is inf, with status 0')
    equal([r['duration_s'] for r in table(ENERGY, '--method', 'leapfrog', '--duration', '9999')], ['1', '10', '100', '1000'],
          'powers of ten up to the duration')
    equal([r['steps'] for r in table(ENERGY, '--method', 'leapfrog', '--duration', '100', '--dt', '0.03')], ['33', '333', '3333'],
          'steps to the nearest whole number')
    equal([r['steps'] for r in table(ENERGY, '--method', 'exact', '--duration', '100', '--dt', '0.06')], ['17', '167', '1667'],
          'up as well as down')
    equal([r['steps'] for r in table(ENERGY, '--method', 'exact', '--duration', '100', '--dt', '3')], ['1', '3', '33'],
          'at least one step')
    rows = table(ENERGY, '--method', 'euler', '--duration', '1e4', '--dt', '1')
    check(float(rows[3]['energy_error_J']) < math.inf == float(rows[4]['energy_error_J']), 'a state that overflows has infinite energy',
          rows)
    for dt in (0.3, 0.0078125):
        for row in table(ENERGY, '--method', 'leapfrog', '--duration', '1e3', '--dt', str(dt)):
            error = float(row['energy_error_J'])
            x = math.cos(int(row['steps']) * 2 * math.asin(dt / 2))  # v^2 + (1 - z^2/4) x^2 is constant
            check(abs(error - dt * dt / 8 * (1 - x * x)) <= 1e-13, f'leapfrog, dt = {dt}: energy after {row["duration_s"]} s', row)
        for row in table(ENERGY, '--method', 'euler', '--duration', '10', '--dt', str(dt)):
            law = (math.exp(int(row['steps']) * math.log1p(dt * dt)) - 1) / 2
            check(abs(float(row['energy_error_J']) / law - 1) <= 1e-12, f'euler, dt = {dt}: growth up to {row["duration_s"]} s', row)
    check(max(column(table(ENERGY, '--method', 'exact', '--duration', '1e8'), 'energy_error_J')) <= 1e-12,
          'exact: no error but rounding')
    check(float(table(ENERGY, '--method', 'rk4', '--duration', '1e4')[4]['energy_error_J']) < 7e-9, 'rk4: the library, too')


def test_energy_jitter():
    how = ['--method', 'leapfrog', '--dt', '0.1', '--duration', '1e4']
    fixed, varied = table(ENERGY, *how), table(ENERGY, *how, '--jitter')
    equal([r['steps'] for r in varied], [r['steps'] for r in fixed], 'jitter: as many steps')
    bound = 0.5 * 0.1 ** 2 / 4
    check(max(column(fixed, 'energy_error_J')) <= bound < 10 * bound < float(varied[-1]['energy_error_J']) < 0.5,
          'jitter: the bound of the energy error is gone', (fixed, varied))
    equal(table(ENERGY, *how, '--jitter'), varied, 'jitter: the same at every run')
    check(max(column(table(ENERGY, *how[2:], '--method', 'exact', '--jitter'), 'energy_error_J')) <= 1e-11,
          'jitter: no matter to the closed form')


# --- numbers: spring-validate, spring-stability, spring-rounding -----------------------------------------------------

def test_validate():
    listed = table(VALIDATE, '--list')
    names = [row['case'] for row in listed]
    check(len(names) >= 25 and len(set(names)) == len(names) and all(row['purpose'] for row in listed), '--list', names)
    rows = table(VALIDATE, '--quick')
    check(len(rows) >= 150 and len({row['case'] for row in rows}) >= 25, '--quick: 150 rows, 25 cases', len(rows))
    equal([name for name in names if name not in {row['case'] for row in rows}],
          ['billion-steps', 'chaotic-50', 'van-der-pol-5', 'stiff-and-soft-10', 'heavy-end', 'stiff-links', 'cloth', 'water',
           'chain-1000', *(f'water-mode-{mode}-{kind}-{n}' for n in (25, 35) for mode in ('1-1', '2-1', '2-2', '3-1')
                           for kind in ('structural', 'mirrored', 'all'))], '--quick leaves out the slow ones')
    equal({row['verdict'] for row in rows}, {'pass'}, '--quick: every check holds, none is skipped')
    check(all(0 <= float(r['error']) <= float(r['bound']) < math.inf for r in rows), '--quick: error <= bound')
    check(all(float(r['error']) > 0 for r in rows if r['witness'] == 'solution' and r['method'] == 'euler'
              and r['case'] != 'at-rest'), '--quick: Euler is never right by accident')
    equal({row['witness'] for row in rows},
          {'iterate', 'solution', 'drive', 'gsl-rk4', 'arkode-rk4', 'gsl-rk8pd', 'cvode-adams', 'cvode-bdf',
           'definition', 'modes', 'reduced-mass', 'digits', 'formula', 'dispersion'}, 'all witnesses')
    equal({row['shape'] for row in rows}, {'spring', 'scene'}, 'springs and scenes')
    check(all(row['reason'] for row in rows), 'every bound says what it is made of')
    equal(table(VALIDATE, '--case', 'middle'), [row for row in rows if row['case'] == 'middle'], '--case: that one and no other')
    bdf = {row['case']: int(row['force_evaluations']) for row in rows if row['witness'] == 'cvode-bdf'}
    check(bdf['settled-0.2'] > 3 * bdf['settled-0.4'] > 0, 'BDF is in trouble on light damping', bdf)


def test_stability():
    rows = table(STABILITY, '--points', '3')
    equal(list(rows[0]), 'method damping_ratio limit_measured limit_theory relative_error'.split(), 'stability: columns')
    zetas = [0, 0.01, 1, 100]
    equal([(r['method'], float(r['damping_ratio'])) for r in rows], [(m, z) for m in ('euler', 'leapfrog', 'rk4') for z in zetas],
          'stability: rows')
    laws = [0, 0.02, 2, 2 / (100 + math.sqrt(9999)), 2, 2, 2, 2, 2 * math.sqrt(2), None, 2.785293563405282,
            2.785293563405282 / (100 + math.sqrt(9999))]
    for row, law in zip(rows, laws):
        name = f'stability: {row["method"]} at damping ratio {row["damping_ratio"]}'
        measured = float(row['limit_measured'])
        check(law is None or abs(measured - law) <= 1e-4 * law, f'{name}: the formula', row)
        check(float(row['relative_error']) <= 1e-4, f'{name}: the library', row)
    cells = table(STABILITY, '--map', '--points', '9')
    equal(len(cells), 3 * 9 * 9, 'map: rows')
    errors = {(r['method'], round(math.log10(float(r['omega_dt'])), 3), round(math.log10(float(r['damping_ratio'])), 3)): float(r['error'])
              for r in cells}
    check(errors['rk4', -2, -1] < errors['leapfrog', -2, -1] < errors['euler', -2, -1] < 1, 'map: the better method', errors)
    check(all(errors[m, 1, 2] > 1e3 for m in ('euler', 'leapfrog', 'rk4')), 'map: beyond the limit', errors)


def test_rounding():
    plain, better = (table(ROUNDING, '--method', 'leapfrog', '--dt', '0x1p-7', '--sum', s, '--steps', '1e5')
                     for s in ('plain', 'compensated'))
    for rows in (plain, better):
        equal([(int(r['steps']), int(r['start'])) for r in rows], [(n, i) for n in (10000, 30000, 100000) for i in range(8)],
              'rounding: rows')
        equal({r['coefficient_error'] for r in rows}, {'0'}, 'rounding: a power of two rounds no coefficient')
    for name in ('state_error', 'energy_error'):
        check(all(e <= int(r['steps']) * 2 * sys.float_info.epsilon for r, e in zip(plain, column(plain, name))),
              f'rounding: {name} within its bound')
        check(max(column(better, name)) <= max(column(plain, name)) / 10, f'rounding: {name} with compensated sums')
    for method in ('leapfrog', 'rk4'):
        rows = table(ROUNDING, '--method', method, '--sum', 'compensated', '--steps', '1e6')[-8:]
        check(all(abs(float(r['state_error']) / float(r['coefficient_error']) - 1) <= 0.05 for r in rows),
              f'rounding: {method}, a decimal step: the coefficient it is', rows)


STEPPERS = {'euler', 'leapfrog', 'rk4'}


def check_work_rows(problem, rows):
    fixed = 'problem solver steps force_evaluations time_s error'.split()
    a_step = {'euler': 1, 'leapfrog': 1, 'rk4': 4, 'gsl-rk4': 11, 'gsl-rk8pd': 13, 'arkode-rk4': 4}
    equal(list(rows[0])[:len(fixed)], fixed, f'work {problem}: columns')
    equal({r['problem'] for r in rows}, {problem}, f'work {problem}: --problem')
    check(all(r[name].isdecimal() for r in rows for name in ('steps', 'force_evaluations')),
          f'work {problem}: counts are whole numbers', rows)
    check(all(float(r['time_s']) > 0 and 0 <= float(r['error']) <= 3 for r in rows), f'work {problem}: times and errors', rows)
    check(a_step.keys() < {r['solver'] for r in rows}, f'work {problem}: all solvers with fixed steps', rows)
    equal([r for r in rows if r['solver'] in a_step
           and not 0 <= int(r['force_evaluations']) - a_step[r['solver']] * int(r['steps']) <= 1], [],
          f'work {problem}: force evaluations of fixed steps, one more at the start')
    equal([r['force_evaluations'] for r in rows if r['solver'] == 'exact'], ['0'] if problem == 'ideal-1' else [],
          f'work {problem}: the closed form where there is one')


def check_work_cheapest(problem, rows, best, solver, time_s):
    """The row of the table against all that are exact enough, and so is the next finer one."""
    sweep = [r for r in rows if r['effort'] == 'sweep']
    finer = [b if a['solver'] == b['solver'] else a for a, b in zip(sweep, [*sweep[1:], sweep[-1]])]
    enough = [r for r, next_one in zip(sweep, finer)
              if max(float(r['error']), float(next_one['error'])) <= float(best['error'])
              and (r['solver'] in STEPPERS if solver == 'solver' else r['solver'] not in {*STEPPERS, 'exact'})]
    least = min((float(r['time_s']) for r in enough), default=math.nan)
    names = {r['solver'] for r in enough if float(r['time_s']) == least} or {'none'}
    check(best[solver] in names and best[time_s] == f'{least:.4g}', f'work {problem}: {solver} at {best["error"]}', (best, names, least))


def test_work_table(folder):
    path = os.path.join(folder, 'table.tsv')
    for problem in ('ideal-1', 'elastic-pendulum'):
        rows = table(WORK, '--problem', problem, '--quick', '--table', path)
        check_work_rows(problem, rows)
        with open(path, encoding='ascii') as file:
            text = file.read()
        check(folder not in text and all(f'# {what}:' in text for what in ('compiler', 'flags', 'processor', 'load')),
              f'work {problem}: the stamp of the table', text)
        levels = parse(text)
        equal([(r['problem'], r['error']) for r in levels], [(problem, f'1e-{n}') for n in range(1, 13)], f'work {problem}: levels')
        for r in levels:
            check_work_cheapest(problem, rows, r, 'solver', 'time_s')
            check_work_cheapest(problem, rows, r, 'peer', 'peer_time_s')
            ratio = float(r['peer_time_s']) / float(r['time_s'])
            check(math.isnan(ratio) == (r['ratio'] == 'nan') and not abs(float(r['ratio']) - ratio) > 2e-3 * ratio,
                  f'work {problem}: ratio at {r["error"]}', r)


def test_work_crossing():
    errors = {(r['solver'], int(r['force_evaluations'])): float(r['error'])
              for r in table(WORK, '--problem', 'ideal-1', '--quick') if r['effort'] == 'crossing'}
    equal(sorted(errors), [(solver, n) for solver in ('leapfrog', 'rk4') for n in (44, 48)], 'work: where RK4 passes leapfrog')
    check(errors['leapfrog', 44] < errors['rk4', 44] and errors['rk4', 48] < errors['leapfrog', 48],
          'work: leapfrog is ahead before, RK4 after', errors)


def test_work_usage():
    result = run(WORK, '--problem', 'ideal-2')
    check(result.returncode == 2 and '"ideal-2"' in result.stderr and 'ideal-10000' in result.stderr, 'work: another problem', result)


def test_bench():
    fixed = 'kernel precision count ns_per_spring_step limit_ns ratio spread verdict'.split()
    small = table(BENCH, '--quick', '--part', 'batch', '--count', '1000')
    sizes = table(BENCH, '--quick', '--kernel', 'leapfrog_batch_16')
    spring = table(BENCH, '--quick', '--part', 'spring', '--kernel', 'rk4')
    scenes = table(BENCH, '--quick', '--part', 'scene', '--count', '7002')
    for rows in (small, sizes, spring, scenes):
        equal(list(rows[0])[:len(fixed)], fixed, 'bench: columns')
        check(all(float(r[name]) > 0 for r in rows for name in ('ns_per_spring_step', 'limit_ns')), 'bench: time passes', rows)
        check(all(abs(float(r['ratio']) - float(r['ns_per_spring_step']) / float(r['limit_ns'])) <= 2e-3 * float(r['ratio'])
                  for r in rows), 'bench: ratio, of figures with four digits', rows)
        check(all((r['verdict'] == 'noisy') == (float(r['spread']) > 0.05) for r in rows if r['spread'] != '0.05'),
              'bench: noisy is a spread above 0.05', rows)
        for r in rows:
            check(r['speedup'] == r['baseline_ns'] == 'nan' or
                  abs(float(r['speedup']) - float(r['baseline_ns']) / float(r['ns_per_spring_step'])) <= 2e-3 * float(r['speedup']),
                  'bench: speedup, of figures with four digits', r)
        excess = [(r, max(float(r['ratio']) / float(r['goal_ratio']), float(r['ns_per_spring_step']) / float(r['goal_ns']),
                          float(r['goal_speedup']) / float(r['speedup']) if r['speedup'] != 'nan' else 0))
                  for r in rows if r['verdict'] != 'noisy']
        check(all((r['verdict'] == 'above_goal') == (x > 1) for r, x in excess if abs(x - 1) > 2e-3),
              'bench: above_goal is one, to four digits', excess)
    equal({r['count'] for r in small}, {'1000'}, 'bench: --count')
    check({'ordinary', 'textbook'} < {r['limit'] for r in small} <= {'ordinary', 'textbook', 'streams', 'arithmetic'},
          'bench: limits', {r['limit'] for r in small})
    equal([(r['precision'], int(r['count'])) for r in sizes],
          [(p, 10**k) for p in ('double', 'float') for k in range(3, 8)], 'bench: counts and precisions')
    equal([(r['kernel'], r['count'], r['limit']) for r in spring], [('rk4', '1', 'loop')], 'bench: one spring')
    check({'leapfrog_sheet_1', 'leapfrog_sheet_16', 'leapfrog_sheet_16_shuffled', 'rk4_sheet_16', 'leapfrog_sheet_16_damping',
           'init_sheet'} <= {r['kernel'] for r in scenes}, 'bench: scenes of 35 x 35 particles, 7002 links', scenes)
    equal({(r['limit'], r['speedup'] != 'nan') for r in scenes if r['kernel'] == 'leapfrog_sheet_16'},
          {('arithmetic', True), ('double', False)}, 'bench: a scene has limits and a plain loop, a float one double')
    equal(table(BENCH, '--calls', '1', '--count', '1000'), [], 'bench: --calls measures nothing')
    result = run(BENCH, '--part', 'scenery')
    check(result.returncode == 2 and '"scenery"' in result.stderr and 'batch' in result.stderr, 'bench: another part', result)


sys.exit(run_tests(globals()))
