#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tables of performance in README.md and on pages of docs, from measurements in docs/data.

usage: performance_tables.py --measure BUILD   measure with the programs of a build folder, and fill the tables
       performance_tables.py --check           fail if the tables are not those of the data
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

DOCS = pathlib.Path(__file__).resolve().parent
SCENES = {'rope': 'rope on two axes', 'cloth': 'cloth, 25 × 25', 'jelly': 'soft body (`jelly`), 8 × 8 × 8'}
PARTICLES = {'rope': 'ropes', 'cloth': 'cloth', 'jelly': 'soft bodies', 'water': 'height-field water'}
COMMANDS = {  # the longer ones first, so that the processor runs at its full clock frequency when the short ones are measured
    'engines': ['spring-engines'],
    'stiff': ['spring-work', '--problem', 'stiff-cloth'],
    'particles': ['spring-scene-map', '--time'],
    'cape': ['spring-work', '--problem', 'cape'],
    'contacts': ['spring-bench', '--part', 'scene', '--kernel', 'leapfrog_sheet_16_on_a_plane'],
    **{f'plan-{scene}': ['spring-plan', '--sag', '0.02', '--scene', scene] for scene in SCENES},
}
WORK = ['cloth', 'long-cloth', 'water', 'damped-cloth', 'stiff-rope']  # stiff-cloth is measured with 'stiff'
OTHER_FILES = {'stiff': {'--table': 'stiff-table', '--forces': 'stiff-forces', '--long': 'stiff-long'}, 'cape': {'--table': 'cape-equal'}}
SOLVERS = {'leapfrog': 'leapfrog', 'xpbd-mesh': 'XPBD', 'xpbd-sheet': 'XPBD for sheets only'}
CAPE, SHEET = 20 * 30, 35 * 35  # particles of the cape of spring-work, and of the sheet of spring-bench
TETHERS = {'none': 'none', 'all': 'all particles', 'rows': 'every seventh row'}


data = DOCS / 'data'


def file(name):
    return data / f'{name}.tsv'


def measure(build):
    """Write the data anew, to the folder data."""
    for name, (program, *options) in COMMANDS.items():
        others = [word for option, other in OTHER_FILES.get(name, {}).items() for word in (option, file(other))]
        subprocess.run([pathlib.Path(build) / 'tools' / program, *options, *others, '-o', file(name)], check=True)
    for problem in WORK:
        subprocess.run([pathlib.Path(build) / 'tools' / 'spring-work', '--problem', problem, '--table', file(f'{problem}-table'),
                        '-o', os.devnull], check=True)


def read(name):
    """Return the comments (by name) and the rows of a data file."""
    lines = file(name).read_text().splitlines()
    comments = dict(line[2:].split(': ', 1) for line in lines if line.startswith('# ') and ': ' in line)
    header, *rows = [line.split('\t') for line in lines if not line.startswith('#')]
    return comments, [dict(zip(header, row)) for row in rows]


def row_where(rows, **values):
    """Return the only row with these values."""
    (row,) = [row for row in rows if all(row[column] == value for column, value in values.items())]
    return row


def two_digits(number):
    """Return a number, rounded to two significant digits."""
    number = float(f'{float(number):.2g}')
    return f'{number:.0f}' if number >= 10 else f'{number:#.2g}'


def table(*lines):
    return '\n'.join(f"| {' | '.join(line)} |" for line in lines)


def performance():
    """Return the tables of README.md."""
    scenes = []
    for scene, title in SCENES.items():
        comments, rows = read(f'plan-{scene}')
        row = row_where([row for row in rows if row.get('precision') != 'float'], limit='scene')
        scenes.append((title, *re.search(r'(\d+) particles, (\d+) links', comments['scene']).groups(),
                       row['steps_per_frame'], f"{two_digits(float(row['time_per_frame_s']) * 1e6)} µs"))
    versions, engines = read('engines')
    xpbd = row_where(read('stiff-forces')[1], problem='stiff-cloth', evaluation='xpbd')
    smallest = min((row['links'] for row in engines), key=int)
    others = [(f'Bullet {versions["bullet"]}, one position iteration per step', 'bullet'),
              (f'Chipmunk2D {versions["chipmunk"]}, damped springs (built by `tools/bench/optimised`)', 'chipmunk')]
    ratios = [(title, two_digits(row_where(engines, engine=name, links=smallest)['speedup'])) for title, name in others]
    ratios.append(('XPBD, written for this comparison, with SIMD, one iteration per step', two_digits(xpbd['ratio'])))
    used = ['engines', 'stiff-forces', *(f'plan-{scene}' for scene in SCENES)]
    processors = {read(name)[0]['processor'] for name in used}
    if len(processors) != 1:
        raise SystemExit(f'the data are of several processors: {processors}')
    (processor,) = processors
    return '\n\n'.join([
        table(('scene', 'particles', 'links', 'steps per frame', 'time per frame (`spring-plan`)'), ['---'] * 5, *scenes),
        table(('', 'time per link and step (leapfrog of this library: 1)'), ['---'] * 2, *ratios),
        f'Measured on one core of an {processor}.'.replace('(R)', ''),
    ])


def particles():
    """Return the table of docs/games.md, and the cost of contacts."""
    rows = [row for row in read('particles')[1] if row['method'] == 'leapfrog' and row['scene'] in PARTICLES]
    comments, runs = read('cape')
    contacts, (plane,) = read('contacts')
    if {read('particles')[0]['processor'], contacts['processor']} != {comments['processor']}:
        raise SystemExit('the data of the cost are of several processors')
    (whole,) = [row for row in runs if row['effort'] == 'fraction' and row['fraction'] == '0.9']
    (alone,) = [row for row in runs if row['effort'] == 'no-figure' and row['tethers'] == 'rows']
    capes = [('a cape on a running figure, float', whole), ('the same cape without the figure', alone)]
    links, free, touching = (float(plane[name]) for name in ('count', 'limit_ns', 'ns_per_spring_step'))
    return '\n\n'.join([
        table(('scene', 'steps per frame', 'particles per millisecond'), ['---'] * 3,
              *((PARTICLES[row['scene']], row['substeps'], two_digits(row['particles_per_ms'])) for row in rows),
              *((title, row['steps_per_frame'], two_digits(CAPE / (float(row['time_us']) / 1e3))) for title, row in capes)),
        f'In a step, a particle of cloth takes {two_digits(free * links / SHEET)} ns, and another '
        f'{two_digits((touching - free) * links / SHEET)} ns if it rests or slides on a collider\n'
        '(`spring-bench --part scene --kernel leapfrog_sheet_16_on_a_plane`).',
    ])


def cape():
    """Return the tables of docs/performance.md."""
    comments, runs = read('cape')
    equal = read('cape-equal')[1]
    rows = []
    for row in equal:
        if row['stretch'] != '0.06':
            continue
        same = {name: row[name] for name in ('solver', 'precision', 'tethers', 'fraction')}
        times = [row, row_where(equal, stretch='0.03', **same)]
        fraction = row['fraction'] if row['solver'] == 'leapfrog' else ''
        rows.append((SOLVERS[row['solver']], row['precision'], TETHERS[row['tethers']], fraction,
                     *(f"{two_digits(time['time_us'])} µs" for time in times)))
    ours = [row for row in equal if row['solver'] == 'leapfrog'][:2] # of cape.c, at both stretches
    ratios = [(SOLVERS[row['solver']] + {'none': '', 'all': ', tethers'}[row['tethers']], f"{100 * float(row['stretch']):g} %",
               two_digits(float(own['time_us']) / float(row['time_us'])))
              for row in equal if row['solver'] != 'leapfrog' for own in ours if own['stretch'] == row['stretch']]
    (whole,) = [row for row in runs if row['effort'] == 'fraction' and row['fraction'] == '0.9']
    parts = {row['tethers']: row for row in runs if row['effort'] == 'no-figure'}
    steps = [('with figure and tethers', whole), ('without the figure', parts['rows']), ('without figure and tethers', parts['none'])]
    return '\n\n'.join([
        table(('solver', 'precision', 'tethers', 'fraction of the stable step', 'stretch 6 % (`spring-work`)', 'stretch 3 %'), ['---'] * 6, *rows),
        table(('compared with', 'stretch', 'time of the first row / time of this solver'), ['---'] * 3, *ratios),
        table((f"{whole['steps_per_frame']} steps per 1/60 s", 'time (`spring-work`)'), ['---'] * 2,
              *((title, f"{two_digits(row['time_us'])} µs") for title, row in steps)),
        f"Measured on one core of an {comments['processor']}.".replace('(R)', ''),
    ])


LONG = {'leapfrog': 'leapfrog', 'xpbd': 'XPBD', 'bdf2-cg': 'BDF2-CG', 'projective': 'projective dynamics',
        'cvode-bdf2': 'CVODE BDF, order 2'}


def long_runs():
    """Return the table of docs/stiffness.md."""
    comments, rows = read('stiff-long')
    runs = {solver: sorted((row for row in rows if row['solver'] == solver), key=lambda row: float(row['frame_s']))
            for solver in [*LONG, 'rkn8']}
    if missing := [solver for solver, run in runs.items() if not run]:
        raise SystemExit(f'spring-work has no long runs of {", ".join(missing)}: use the SUNDIALS that tools/bench/optimised builds')
    frame = float(runs['leapfrog'][0]['frame_s'])
    chosen = [(title, min(runs[solver], key=lambda row: abs(math.log(float(row['frame_s']) / frame)))) for solver, title in LONG.items()]
    chosen.append(('RKN8, an accurate run', runs['rkn8'][-1]))
    steps = ['steps_per_frame', 'frame_s', 'error_500ms', 'error_1s', 'sag_m', 'stretch_99', 'energy_change']
    lines = []
    for title, row in chosen:
        n, frame_s, *errors, sag, stretch, energy = (float(row[name]) for name in steps)
        lines.append((title, f'{n:.0f}' if n else 'adaptive', f'{two_digits(frame_s * 1e6)} µs', *(f'{error:.2g}' for error in errors),
                      f'{sag:.2f} m', f'{100 * stretch:.2g} %', f'{100 * energy:+.0f} %'.replace('-', '−').replace('−0', '0')))
    return '\n\n'.join([
        table(('', 'steps per frame', 'time per frame (`spring-work`)', 'error after 0.5 s', 'after 1 s', 'depth', 'stretch', 'change of energy'),
              ['---'] * 8, *lines),
        f'Measured on one core of an {comments["processor"]}.'.replace('(R)', ''),
    ])


ERRORS = [f'1e-{digits}' for digits in range(1, 11)]
NAMES = {'euler': 'Euler', 'symplectic-euler': 'symplectic Euler', 'leapfrog': 'leapfrog', 'rk4': 'RK4', 'rkn8': 'RKN8', 'srkn6': 'SRKN6', 'none': '–'}


def cheapest():
    """Return the table of docs/methods.md of the cheapest methods."""
    lines = []
    for problem in [*WORK, 'stiff']:
        comments, rows = read(f'{problem}-table')
        (duration,) = {f"{float(row['steps']) * float(row['dt_s']):.2g} s" for row in rows if row['solver'] != 'none'}
        cells = []
        for error in ERRORS:
            row = row_where(rows, error=error)
            ratio = two_digits(row['ratio']) if row['ratio'] != 'nan' else '–'
            cells.append(f"{NAMES[row['solver']]}, {ratio}" if row['solver'] != 'none' else '–')
        lines.append((rows[0]['problem'], duration, *cells))
    return '\n\n'.join([
        table(('problem (`spring-work`)', 'time', *ERRORS), ['---'] * (2 + len(ERRORS)), *lines),
        f'Measured on one core of an {comments["processor"]}.'.replace('(R)', ''),
    ])


STIFF = {'leapfrog': 'leapfrog', 'bdf2-cg': 'BDF2-CG', 'cvode-bdf': 'CVODE, BDF', 'cvode-adams': 'CVODE, Adams', 'xpbd': 'XPBD'}


def stiff_solvers():
    """Return the table of docs/methods.md of solvers for the stiff cloth."""
    comments, rows = read('stiff')
    lines = []
    for solver, title in STIFF.items():
        runs = [row for row in rows if row['solver'] == solver and not float(row['stable_fraction']) >= 1]
        times = [[float(row['time_s']) for row in runs if float(row['error']) <= float(error)] for error in ERRORS[:5]]
        lines.append((title, *(f'{two_digits(min(time) * 1e3)} ms' if time else '–' for time in times)))
    return '\n\n'.join([
        table(('error (`spring-work`)', *ERRORS[:5]), ['---'] * 6, *lines),
        f'Measured on one core of an {comments["processor"]}.'.replace('(R)', ''),
    ])


PAGES = {DOCS.parent / 'README.md': [performance], DOCS / 'games.md': [particles], DOCS / 'performance.md': [cape],
         DOCS / 'stiffness.md': [long_runs], DOCS / 'methods.md': [cheapest, stiff_solvers]}


def fill():
    """Return the pages and their texts, with the tables of the data."""
    texts = {}
    for page, tables in PAGES.items():
        text = page.read_text()
        place = re.compile(r'(<!-- performance -->\n\n).*?(\n\n<!-- end -->)', re.S)
        if len(place.findall(text)) != len(tables):
            raise SystemExit(f'{page} does not have {len(tables)} places for tables')
        next_table = iter(tables)
        texts[page] = place.sub(lambda m: m[1] + next(next_table)() + m[2], text)
    return texts


def main():
    global data
    option, *build = sys.argv[1:] or ['']
    if (option, len(build)) not in (('--measure', 1), ('--check', 0)):
        raise SystemExit(__doc__)
    if not build:
        for page, text in fill().items():
            if page.read_text() != text:
                raise SystemExit(f'the tables of {page} are not those of docs/data: docs/performance_tables.py --measure fills them')
        return
    with tempfile.TemporaryDirectory() as folder: # so that an error leaves the old data and tables as they are
        old, data = data, pathlib.Path(folder)
        measure(build[0])
        texts = fill()
        shutil.copytree(data, old, dirs_exist_ok=True)
    for page, text in texts.items():
        page.write_text(text)


main()
