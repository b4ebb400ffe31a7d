# SPDX-License-Identifier: MIT
"""The option that Meson's protocol "gtest" requires."""


def pytest_addoption(parser):
    """Meson asks for a JUnit file in these words, and takes the test cases from there."""
    parser.addoption('--gtest_output', dest='xmlpath', type=lambda words: words.removeprefix('xml:'))
