# SPDX-License-Identifier: MIT
"""Documentation of the tools: --help, man pages, bash completion, suggestions for typing errors."""
import pathlib
import re
import shlex
import shutil
import subprocess

import pytest
from tools import (BENCH, EVERY, METHODS, PLAN, RUN, SCENE, SHORT, STABILITY, USERS, WORK, choices, every_tool, is_failure, parse, run)

MAIN = EVERY | {  # with the columns that are told; SHORT asks some for others
    STABILITY: ['--points', '1'],
    PLAN: ['--error', '.1', '--duration', '1', '--hertz', '1'],
}
each_user_tool = pytest.mark.parametrize('tool', USERS)
FOLDER = pathlib.Path(shutil.which(RUN)).parent


def help_of(tool):
    result = run(tool, '--help')
    assert (result.returncode, result.stderr) == (0, '')
    return result.stdout


def examples_of(tool):
    part = help_of(tool).partition('\nExamples:\n')[2].partition('\nRead ')[0]
    return [line.strip() for line in part.splitlines()]


def options_of(tool):
    """Each option with its value, if it takes one, and its line."""
    found = re.findall(r'^  (?:-., )?--([\w-]+)(?: ([^ ]+))? +(\S.*)$', help_of(tool), re.M)
    return [(name, value, line) for name, value, line in found]


def test_every_tool_is_looked_at():
    built = {path.name for path in FOLDER.glob('spring-*') if path.is_file() and '.' not in path.name}
    assert built == set(EVERY)


# --- help -----------------------------------------------------------------------------------------------------------

@every_tool
def test_help_fits_a_screen(tool):
    lines = help_of(tool).splitlines()
    assert lines[0].startswith(f'Usage: {tool} ') and len(lines) <= 50 and max(map(len, lines)) <= 100
    assert run(tool, '-h').stdout == help_of(tool)


@every_tool
def test_columns_in_help_are_those_of_the_table(tool):
    told = help_of(tool).partition('\nColumns: ')[2].partition('\nExamples:')[0].split()
    header = next(line for line in run(tool, *MAIN[tool]).stdout.splitlines() if not line.startswith('#'))
    assert told == header.split('\t')


@every_tool
def test_examples_work(tool, tmp_path):
    examples = examples_of(tool)
    assert len(examples) == 3
    for example in examples:
        assert example.split()[0] == tool
        result = subprocess.run(['sh', '-c', example], cwd=tmp_path, stdin=subprocess.DEVNULL, capture_output=True,
                                text=True, timeout=100, check=False)
        assert result.returncode == 0, (example, result.stderr)
        written = re.search(r' -o (\S+)', example)
        text = (tmp_path / written[1]).read_text() if written else result.stdout
        assert len(text.splitlines()) > 1, example


@every_tool
def test_ways_to_read_a_table(tool, tmp_path):
    """With its own table: the columns are there, and awk's numbers are those of them."""
    path = tmp_path / 'table.tsv'
    run(tool, *MAIN[tool], '-o', path)
    gnuplot, awk = (command.replace('FILE', str(path)) for command in re.search(
        r'Read FILE in gnuplot: (.*)\n  in awk: (.*)  in pandas: read_csv\("FILE", sep="\\t", comment="#"\)\n', help_of(tool)).groups())
    x, y = re.search(r'using "(\w+)":"(\w+)"', gnuplot).groups()
    shown = subprocess.run(['sh', '-c', awk], capture_output=True, text=True, check=True).stdout.splitlines()
    assert shown == [f'{x} {y}', *(f'{row[x]} {row[y]}' for row in parse(path.read_text()))]
    drawn = subprocess.run(['gnuplot', '-e', f'set terminal dumb; {gnuplot}'], capture_output=True, text=True, check=False)
    assert (drawn.returncode, 'no column' in drawn.stderr) == (0, False), drawn.stderr


WITH_OTHERS = {'frame-rate', 'particle-radius', 'seed', 'push-duration', 'axes', 'links', 'columns'}  # refused where they do not count
LACKED = {'chain': ['gravity'], 'water': ['gravity'], PLAN: ['damping', 'damping-ratio']}  # by --presets, which SHORT asks for


@pytest.mark.parametrize('tool, more', [*((tool, []) for tool in SHORT),
                                         *((SCENE, ['--scene', scene]) for scene in choices(SCENE, '--scene'))])
def test_defaults_are_what_is_taken(tool, more):
    """A default is said in one way, and giving it is as good as giving nothing."""
    given = []
    for name, _, line in options_of(tool):
        assert len(re.findall('default', line)) == len(re.findall(r'\(default: [^()]+\)$', line)), line
        told = re.search(r'\(default: ([-+.\w]+)\)$', line)
        taken = name not in WITH_OTHERS and name not in LACKED.get((more or [tool])[-1], [])
        if told and f'--{name}' not in SHORT[tool] and taken:
            given += [f'--{name}', told[1]]
    assert rows_of(tool, *given, *more) == rows_of(tool, *more)


def rows_of(tool, *more):
    result = run(tool, *SHORT[tool], *more)
    assert result.returncode == 0, result.stderr
    return parse(result.stdout)


# --- the manual -----------------------------------------------------------------------------------------------------

@pytest.mark.skipif(shutil.which('man') is None, reason='no man, which checks pages of the manual')
@each_user_tool
def test_page_is_shown_without_a_warning(tool, tmp_path):
    page = tmp_path / f'{tool}.1'
    page.write_text(run(tool, '--man').stdout)
    result = subprocess.run(['man', '--warnings', '-E', 'UTF-8', '-l', page], capture_output=True, text=True, check=False,
                            env={'MANWIDTH': '100', 'PATH': '/usr/bin:/bin', 'LC_ALL': 'C.UTF-8', 'MAN_KEEP_FORMATTING': ''})
    assert (result.returncode, result.stderr) == (0, '')
    shown = result.stdout
    sections = re.findall(r'^[A-Z][A-Z ]+$', shown, re.M)
    assert sections == ['NAME', 'SYNOPSIS', 'DESCRIPTION', 'OPTIONS', 'OUTPUT', 'EXIT STATUS', 'EXAMPLES', 'SEE ALSO']
    words = ' '.join(shown.replace('\N{HYPHEN}\n', '').split())
    told = [f'--{name}' for name, *_ in options_of(tool)] + [' '.join(line.split()) for line in examples_of(tool)]
    assert [what for what in told if what not in words] == []


# --- completion -----------------------------------------------------------------------------------------------------

def complete(*words):
    """What bash completes where the last word ends; = is a word of its own there."""
    script = '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _springstep "$1"; printf "%s\\n" "${COMPREPLY[@]}"'
    result = subprocess.run(['bash', '-c', script, FOLDER / 'springstep', *words], capture_output=True, text=True,
                            check=False)
    assert (result.returncode, result.stderr) == (0, '')
    return result.stdout.split()


@each_user_tool
def test_options_are_completed(tool):
    names = {f'--{name}' for name, *_ in options_of(tool)}
    assert set(complete(tool, '')) == names | {'--help', '--version'} and complete(tool, '--vers') == ['--version']


@pytest.mark.parametrize('words, wanted', [
    ([RUN, '--method', ''], METHODS),
    ([RUN, '--method', 'lea'], ['leapfrog']),
    ([RUN, '--dt', '1', '--method', '=', 'rk'], ['rk4']),
    ([RUN, '--method', '='], METHODS),
    ([RUN, '--dt', ''], []),
    ([RUN, '--arithmetic', 's'], ['stages']),
    ([SCENE, '--scene', ''], ['rope', 'cloth', 'jelly', 'chain', 'water']),
    ([SCENE, '--hash', '--posi'], ['--positions']),
], ids=' '.join)
def test_words_are_completed(words, wanted):
    assert complete(*words) == wanted


@pytest.mark.parametrize('folder', ['~', '$NO_FOLDER', FOLDER], ids=['at home', 'in a variable', 'full path'])
def test_tools_are_asked_wherever_they_are(folder, monkeypatch):
    monkeypatch.setenv('HOME', str(FOLDER))
    if folder == '~':
        monkeypatch.setenv('PATH', '/usr/bin:/bin')
    assert complete(f'{folder}/{RUN}', '--method', 'lea') == ['leapfrog']


def test_files_are_completed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'spring.tsv').touch()
    (tmp_path / 'sprung').mkdir()
    assert complete(RUN, '-o', 'sp') == complete(RUN, '--output', 'sp')
    assert sorted(complete(RUN, '-o', 'sp')) == ['spring.tsv', 'sprung']
    assert complete(SCENE, '--frames', 'sp') == ['sprung']


# --- did you mean ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('words, meant', [
    (f'{RUN} --mehtod rk4', '--method'), (f'{RUN} -method rk4', '--method'), (f'{RUN} --meth=rk4', '--method'),
    (f'{RUN} --dur 3', '--duration'), (f'{RUN} duration 3', '--duration'), (f'{RUN} --stifness=1', '--stiffness'),
    (f'{RUN} --hlep', '--help'), (f'{RUN} --method leapfrgo', '"leapfrog"'), (f'{RUN} --method RK4', '"rk4"'),
    (f'{RUN} --method symplectic', '"symplectic-euler"'), (f'{RUN} --method rk4 --arithmetic stage', '"stages"'),
    (f'{SCENE} --scene clot', '"cloth"'), (f'{PLAN} --scene wather', '"water"'), (f'{BENCH} --part bacth', '"batch"'),
    (f'{WORK} --problem ideal-1000', '"ideal-100"'),
])
def test_meant(words, meant):
    is_failure(run(*words.split()), 2, f'; did you mean {meant}?')


@pytest.mark.parametrize('words', [
    f'{RUN} --bogus', f'{RUN} --y', f'{RUN} --', f'{RUN} --{"method" * 20}', f'{RUN} --method verlet',
    f'{SCENE} --scene sea', f'{RUN} --steps methods', f'{RUN} --method {"leapfrog" * 10000}'], ids=lambda words: words[:40])
def test_nothing_is_like_it(words):
    result = run(*shlex.split(words))
    assert result.returncode == 2 and 'did you mean' not in result.stderr
