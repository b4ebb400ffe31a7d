# SPDX-License-Identifier: MIT
"""Output of the tools: standard output, and files that are either complete or absent however a run ends."""
import os
import pathlib
import resource
import shutil
import signal
import stat
import subprocess
import tempfile
import time

import pytest
from tools import ENERGY, ENGINES, EVERY, ORDER, RUN, SHORT, each_tool, is_failure, run

each_way_to_print = pytest.mark.parametrize(
    'tool, args', [(tool, args) for tool in SHORT for args in (SHORT[tool], ['--help'], ['--version'])])
overflow = ['--method', 'euler', '--duration', '1e6', '--steps', '1000']  # ends with status 1


def files(folder):
    return {path.name: path.read_text() for path in folder.iterdir()}


# --- what cannot be written -----------------------------------------------------------------------------------------

@each_way_to_print
def test_full_disk(tool, args):
    with open('/dev/full', 'wb') as full:
        is_failure(run(tool, *args, stdout=full), 3, 'cannot write standard output: ')


@each_way_to_print
def test_closed_output(tool, args):
    is_failure(run(tool, *args, preexec_fn=lambda: os.close(1)), 3, 'cannot write standard output: ')


@pytest.mark.parametrize('tool, args', [(tool, args) for tool in EVERY for args in (
    EVERY[tool], ['--help'], ['--version'], ['--man'], ['--completion'])])
def test_closed_pipe(tool, args):
    """Ends it as it ends other programs: by SIGPIPE, silently."""
    reader, writer = os.pipe()
    os.close(reader)
    result = run(tool, *args, stdout=writer)
    os.close(writer)
    said = '' if tool == ENGINES else result.stderr  # what an engine says
    assert (result.returncode, said) == (-signal.SIGPIPE, '')


def test_pipe_that_closes_on_the_way(tmp_path):
    many = [*SHORT[RUN], '--steps', '1e5', '--envelope', str(tmp_path / 'envelope.tsv')]
    result = run('sh', '-c', '"$@" | head -n 1', 'sh', RUN, *many)
    assert (result.stdout.count('\n'), result.stderr, files(tmp_path)) == (1, '', {})


@each_tool
@pytest.mark.parametrize('path', ['/dev/full', '', 'no/such', 'old.tsv/x', 'dangling', 'x' * 300, 'x/' * 3000],
                         ids=lambda path: path[:20] or 'a folder')
def test_file_that_cannot_be_written(tool, path, older):
    folder = older.parent
    (folder / 'dangling').symlink_to(folder / 'no' / 'such')
    path = os.path.join(folder, path)
    result = run(tool, *SHORT[tool], '-o', path)
    is_failure(result, 3, f'--output: cannot write "{path}": ', 'should be a file that can be')
    assert older.read_text() == 'older\n' and sorted(os.listdir(folder)) == ['dangling', 'old.tsv']


@each_tool
def test_file_size_limit(tool, older):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    is_failure(run(tool, *SHORT[tool], '-o', older, preexec_fn=limit), 3, '--output: ')
    assert files(older.parent) == {'old.tsv': 'older\n'}


def test_read_only_file():
    """Root may write what its owner has made read-only, so root tries as somebody else."""
    somebody = {'user': 65534, 'group': 65534, 'extra_groups': []} if os.geteuid() == 0 else {}
    with tempfile.TemporaryDirectory() as folder:  # open to others, as the folder of tmp_path is not
        os.chmod(folder, 0o777)
        older = pathlib.Path(folder, 'old.tsv')
        older.write_text('older\n')
        older.chmod(0o444)
        try:
            result = run(ORDER, *SHORT[ORDER], '-o', older, **somebody)
        except PermissionError:
            pytest.skip('the tools are in a folder that is closed to others')
        is_failure(result, 3, 'Permission denied')
        assert files(older.parent) == {'old.tsv': 'older\n'}


# --- what ends on the way -------------------------------------------------------------------------------------------

def test_failed_run_leaves_the_older_file(older):
    result = run(ORDER, *'--method rk4 --duration 1e9 --n-max 5000'.split(), '-o', older)
    assert (result.returncode, files(older.parent)) == (1, {'old.tsv': 'older\n'})


def test_file_that_cannot_be_created_is_noticed_before_the_run():
    assert run(RUN, *overflow, '-o', 'x' * 300).returncode == 3


def test_all_files_or_none(older):
    is_failure(run(RUN, *SHORT[RUN], '-o', older, '--envelope', '/dev/full'), 3, '--envelope')
    assert files(older.parent) == {'old.tsv': 'older\n'}


def ended_by(older, *numbers, times=1):
    """The status of a run that gets these signals while it writes."""
    def prepare():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)
    with subprocess.Popen([ENERGY, '--method', 'rk4', '--duration', '1e9', '-o', older], preexec_fn=prepare) as process:
        patience = time.monotonic() + 60
        while len(os.listdir(older.parent)) < 2 and time.monotonic() < patience:
            time.sleep(0.001)
        begun = len(os.listdir(older.parent))
        for number in numbers * times:
            os.kill(process.pid, number)  # not send_signal(), which looks first whether the process has ended
        status = process.wait(60)
    assert (begun, files(older.parent)) == (2, {'old.tsv': 'older\n'})
    return status


@pytest.mark.parametrize('name', 'HUP INT QUIT ALRM TERM USR1 USR2 XCPU'.split())
def test_signal(name, older):
    number = signal.Signals['SIG' + name]
    assert ended_by(older, number) == -number


def test_more_signals_while_the_first_is_handled(older):
    """As timeout sends them. The run ends by the first that it gets, which of different ones is not known."""
    for _ in range(20):
        assert ended_by(older, signal.SIGTERM, times=50) == -signal.SIGTERM
        assert -ended_by(older, signal.SIGINT, signal.SIGTERM, times=5) in (signal.SIGINT, signal.SIGTERM)


def test_ignored_signal_stays_ignored(tmp_path):
    """As nohup asks for it."""
    with subprocess.Popen([RUN, *SHORT[RUN], '--steps', '3e6', '--every', '1000', '-o', tmp_path / 'new.tsv'],
                          preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)) as process:
        process.send_signal(signal.SIGHUP)
        assert process.wait(60) == 0
    assert list(files(tmp_path)) == ['new.tsv']


# --- the same bytes -------------------------------------------------------------------------------------------------

SAME = {  # ways to run a tool again: more words, and how
    'again': ([], {}),
    'from another place': ([], {'cwd': '/', 'env': {}}),
    'under another name': ([], {'name': '/elsewhere/other-name'}),
    'to /dev/stdout': (['-o', '/dev/stdout'], {}),
    **{spelling: (spelling.split(), {}) for spelling in ['-o FILE', '-oFILE', '--output FILE', '--output=FILE']},
    'without standard error': (['-o', 'FILE'], {'preexec_fn': lambda: os.close(2)}),
    'umask': (['-o', 'FILE'], {'umask': 0o027}),
}


@each_tool
@pytest.mark.parametrize('way', SAME)
def test_same_bytes(tool, way, tmp_path):
    more, how = SAME[way]
    path = tmp_path / 'new.tsv'
    how = {'executable': shutil.which(tool), **how}
    result = run(how.pop('name', tool), *SHORT[tool], *(word.replace('FILE', str(path)) for word in more), **how)
    assert result.returncode == 0
    assert (path.read_text() if 'FILE' in ' '.join(more) else result.stdout) == run(tool, *SHORT[tool]).stdout
    assert list(files(tmp_path)) == ([path.name] if 'FILE' in ' '.join(more) else [])
    assert way != 'umask' or stat.S_IMODE(path.stat().st_mode) == 0o640


@each_tool
def test_link_stays_a_link_and_a_file_keeps_its_mode(tool, older):
    link = older.parent / 'link.tsv'
    link.symlink_to(older.name)
    older.chmod(0o640)
    run(tool, *SHORT[tool], '-o', link)
    assert link.is_symlink() and stat.S_IMODE(older.stat().st_mode) == 0o640
    want = run(tool, *SHORT[tool]).stdout
    assert files(older.parent) == {'link.tsv': want, 'old.tsv': want}


# --- pipes and devices are written directly -------------------------------------------------------------------------

def through_fifo(folder, tool, *args, **how):
    fifo = folder / 'fifo'
    os.mkfifo(fifo)
    with subprocess.Popen(['cat', fifo], stdout=subprocess.PIPE, text=True) as reader:
        result = run(tool, *args, '-o', fifo, **how)
        return result.returncode, reader.communicate(timeout=60)[0]


def test_fifo(tmp_path):
    assert through_fifo(tmp_path, ORDER, *SHORT[ORDER]) == (0, run(ORDER, *SHORT[ORDER]).stdout)


def test_no_message_among_the_rows(tmp_path):
    status, rows = through_fifo(tmp_path, RUN, *overflow, preexec_fn=lambda: os.close(2))
    assert status == 1 and 'infinite' not in rows


def test_dev_stdout_appends_where_standard_output_does(older):
    with open(older, 'a', encoding='ascii') as log:
        run(ORDER, *SHORT[ORDER], '-o', '/dev/stdout', stdout=log)
    assert older.read_text() == 'older\n' + run(ORDER, *SHORT[ORDER]).stdout


def test_names_of_open_files_keep_what_they_have(older):
    rows = run(ORDER, *SHORT[ORDER]).stdout
    for name, redirected in [('/dev/fd/1', 'stdout'), ('/dev/stderr', 'stderr'), ('/proc/self/fd/2', 'stderr')]:
        with open(older, 'w', encoding='ascii') as log:
            log.write('older\n')
            log.flush()
            run(ORDER, *SHORT[ORDER], '-o', name, **{redirected: log})
            log.seek(0, os.SEEK_CUR)
            os.write(log.fileno(), b'newer\n')
        assert older.read_text() == 'older\n' + rows + 'newer\n'
    is_failure(run(RUN, *SHORT[RUN], '--every', '1', '--envelope', '/dev/fd/1'), 2, '--envelope', '"/dev/fd/1"', 'another file')


def test_dev_fd(older):
    inode = older.stat().st_ino
    with open(older, 'w', encoding='ascii') as log:
        run(ORDER, *SHORT[ORDER], '-o', f'/dev/fd/{log.fileno()}', pass_fds=[log.fileno()])
    assert (older.stat().st_ino, older.read_text()) == (inode, run(ORDER, *SHORT[ORDER]).stdout)
