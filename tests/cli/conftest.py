# SPDX-License-Identifier: MIT
"""The tests of command-line tools, which must be in PATH. To run them by hand:

    PATH=$PWD/build/tools:$PATH /usr/bin/python3 -m pytest tests/cli
"""
import os

import pytest

pytest.register_assert_rewrite('tools')


def pytest_addoption(parser):
    """Meson's protocol "gtest" asks for a JUnit file in these words, and takes the test cases from there."""
    parser.addoption('--gtest_output', dest='xmlpath', type=lambda words: words.removeprefix('xml:'))


@pytest.fixture
def older(tmp_path):
    """A file that is there already, alone in a folder."""
    path = tmp_path / 'old.tsv'
    path.write_text('older\n')
    return path


@pytest.fixture
def terminal():
    """Its own end, and the end for programs."""
    try:
        ends = os.openpty()
    except OSError as error:
        pytest.skip(f'no pseudo-terminal: {error}')
    yield ends
    os.close(ends[0])
    os.close(ends[1])
