# SPDX-License-Identifier: MIT
"""The test of examples/sdl, under a separate X server. To run it by hand:

    SPRINGS=$PWD/build/examples/springs PATH=$PWD/build/tools:$PATH /usr/bin/python3 -m pytest tests/windows
"""
import os
import shutil
import subprocess

import pytest

from windows import Screen


def pytest_addoption(parser):
    """Meson's protocol "gtest" asks for a JUnit file in these words, and takes the test cases from there."""
    parser.addoption('--gtest_output', dest='xmlpath', type=lambda words: words.removeprefix('xml:'))


@pytest.fixture
def screen(tmp_path):
    """An X server without a window manager, whose picture lies in a file. Each test has its own: a server starts anew when
    its last window closes, and refuses whoever comes meanwhile."""
    for command in 'Xvfb', 'xdotool':
        if shutil.which(command) is None:
            pytest.skip(f'no {command}')
    folder = tmp_path / 'screen'
    folder.mkdir()
    read, write = os.pipe()
    with subprocess.Popen(['Xvfb', '-displayfd', str(write), '-screen', '0', '1024x768x24', '-fbdir', folder,
                           '-nolisten', 'tcp'],
                          pass_fds=[write], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as number:
            display = number.readline().strip()
        assert display, 'Xvfb has not started'
        yield Screen(f':{display}', folder / 'Xvfb_screen0')
        server.terminate()
