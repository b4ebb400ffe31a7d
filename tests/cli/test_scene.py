# SPDX-License-Identifier: MIT
"""spring-scene and spring-scene-map: what the ready scenes do, what pushes do to them, frames, explosions. Prints TAP.

Usage: test_scene.py PATH/spring-scene PATH/spring-scene-map
"""
import math
import os
import sys

from tap import check, column, equal, parse, run, run_tests, table

SCENE, MAP = 'spring-scene', 'spring-scene-map'
SHEET = 2 * 25 * 24 + 2 * 24**2 + 2 * 25 * 23  # structural, shear and bend links
BLOCK = 3 * 7 * 8**2 + (2 * 3 * 7**2 * 8 + 4 * 7**3) + 3 * 6 * 8**2
SCENES = {'rope': (20, 19), 'cloth': (625, SHEET), 'jelly': (512, BLOCK), 'chain': (52, 51), 'water': (625, SHEET)}
METHODS = 'euler', 'leapfrog', 'rk4'
ORDER = {'euler': 1, 'leapfrog': 2, 'rk4': 4}
FREE_WATER = ['--scene', 'water', '--size', '9', '--stiffness', '0', '--drag', '0', '--mass', '1.3', '--method', 'rk4',
              '--dt', '0x1p-12', '--fps', '16', '--duration', '0.5']


def frames_of(folder, *args):
    """Rows of the last frame, and of the one before."""
    path = os.path.join(folder, 'positions.tsv')
    result = run(SCENE, *args, '--positions', path)
    check(result.returncode == 0, f'runs: {" ".join(args)}', result.stderr)
    with open(path, encoding='ascii') as file:
        rows = parse(file.read())
    times = sorted({float(row['t_s']) for row in rows})
    return [[row for row in rows if float(row['t_s']) == t] for t in times[-1:-3:-1]]


def momentum(folder, *args, mass=1.3):
    """Of free particles [kg m/s], upwards: they have left their places, and nothing pulls them back."""
    last, before = frames_of(folder, *FREE_WATER, *args)
    dt = float(last[0]['t_s']) - float(before[0]['t_s'])
    return sum(mass * (float(a['z_m']) - float(b['z_m'])) / dt for a, b in zip(last, before, strict=True))


# --- scenes ---------------------------------------------------------------------------------------------------------

def test_each_scene_with_each_method():
    for scene, (particles, links) in SCENES.items():
        for method in METHODS:
            result = run(SCENE, '--scene', scene, '--method', method, '--duration', '0.1')
            rows = parse(result.stdout)
            name = f'{scene}, {method}'
            equal(result.returncode, 0, f'{name}: runs')
            check(f'{particles} particles, {links} links' in result.stdout, f'{name}: size', result.stdout[:400])
            check(all(abs(float(r['energy_J']) - math.fsum(float(r[part]) for part in ('kinetic_J', 'elastic_J', 'gravity_J')))
                      <= 1e-13 * (1 + abs(float(r['energy_J']))) for r in rows), f'{name}: the energy is the sum of its parts')
            check(0 < float(rows[-1]['max_displacement_m']) < (math.inf if method == 'euler' else 1) and float(rows[0]['max_displacement_m']) == 0,
                  f'{name}: it moves', rows)
            equal([round(60 * t, 9) for t in column(rows, 't_s')], list(range(7)), f'{name}: 60 rows a second, evenly')
            check((result.stderr == '') == (method != 'euler'), f'{name}: only Euler is remarked on', result.stderr)


def test_energy_is_kept():
    """Without drag and pushes: leapfrog to second order, so that half the step leaves a quarter of the error."""
    for scene in ('rope', 'cloth', 'jelly', 'chain'):
        worst = []
        for dt in ('0x1p-11', '0x1p-12'):
            energy = column(table(SCENE, '--scene', scene, '--method', 'leapfrog', '--drag', '0', '--dt', dt, '--duration', '1'),
                            'energy_J')
            worst.append(max(abs(e - energy[0]) for e in energy))
        ratio = worst[0] / worst[1]
        check(3.5 <= ratio <= 4.5, f'{scene}: the energy error falls with the square of the step', worst)


def test_orders(folder):
    """The three methods are three: where the water is after the poke differs from RK4's in short steps as the orders say."""
    water = ['--scene', 'water', '--size', '9', '--duration', '0.03125', '--fps', '32', '--push-duration', '0.015']
    finest = {'euler': 18, 'leapfrog': 14, 'rk4': 11}

    def heights(method, power):
        return column(frames_of(folder, *water, '--method', method, '--dt', f'0x1p-{power}')[0], 'z_m')

    truth = heights('rk4', 14)
    for method, power in finest.items():
        errors = [math.dist(heights(method, power - i), truth) for i in (0, 1)]
        slope = math.log2(errors[1] / errors[0])
        check(abs(slope - ORDER[method]) <= 0.15, f'water, {method}: order {ORDER[method]}', (slope, errors))


def test_water_with_tension(folder):
    """On three axes small waves are those of a height field whose links have the part 1 - 1/stretch of the stiffness."""
    base = ['--scene', 'water', '--size', '11', '--method', 'rk4', '--stretch', '1.6', '--links', 'structural', '--duration', '0.0625', '--fps', '16',
            '--poke', '0,1.7,2.2,20,0.5', '--dt', '0x1p-12']
    flat, deep = (column(frames_of(folder, *base, '--axes', axes)[0], 'z_m') for axes in ('1', '3'))
    size = max(map(abs, flat))
    # What is left out changes the stiffness of a link by the square of its slope; over 17 rad of the fastest wave.
    bound = 17 * 9 * size * (size / 0.4)**2  # of 9 x 9 particles that move
    check(math.dist(flat, deep) <= bound and size > 1e-6, 'three axes: the waves of one', (math.dist(flat, deep), bound, size))


def test_end_mass():
    light = table(SCENE, '--scene', 'rope', '--method', 'leapfrog', '--duration', '0.5')
    heavy = table(SCENE, '--scene', 'rope', '--method', 'leapfrog', '--duration', '0.5', '--end-mass', '0.15')
    equal(table(SCENE, '--scene', 'rope', '--method', 'leapfrog', '--duration', '0.5', '--end-mass', '0.05'), light,
          'rope: a last particle like the others')
    check(1.05 < float(heavy[-1]['kinetic_J']) / float(light[-1]['kinetic_J']) < 4, 'rope: a heavy end takes more energy')


def test_cloth_and_gravity(folder):
    last = frames_of(folder, '--scene', 'cloth', '--method', 'leapfrog', '--duration', '0.2', '--fps', '10')[0]
    at_start = [(r['i'], r['j']) for r in last if float(r['z_m']) == 0]
    equal(at_start, [('0', '0'), ('24', '0')], 'cloth: hangs on two corners')
    up = frames_of(folder, '--scene', 'cloth', '--method', 'leapfrog', '--duration', '0.2', '--fps', '10', '--gravity', '-9.81')[0]
    equal([-float(r['z_m']) for r in up], [float(r['z_m']) for r in last], 'cloth: gravity upwards, the mirror image')
    chain = frames_of(folder, '--scene', 'chain', '--method', 'leapfrog', '--duration', '0.5', '--fps', '2')[1]
    aside = [float(r['x_m']) - 5 * i / 51 for i, r in enumerate(chain)]
    check(math.dist(aside, [5 / 51 * min(i, 51 - i) / 51 for i in range(52)]) <= 1e-14, 'chain: drawn aside by half a spacing', aside)


def test_damping():
    """Of links: a chain in its lowest mode, nearly, loses energy as exp(-lambda t c/m); here most of it within seconds."""
    def energies(damping):
        return column(table(SCENE, '--scene', 'chain', '--size', '3', '--method', 'rk4', '--dt', '0x1p-9', '--duration', '4',
                            '--damping', damping, '--fps', '1'), 'energy_J')
    free, damped = energies('0'), energies('0.05')
    check(abs(free[-1] / free[0] - 1) <= 1e-4, 'damping: none but what RK4 loses, z^6/72 a step', free)
    # the lowest of three modes has 2 - sqrt(2) of c/m = 0.5/s, the highest 2 + sqrt(2)
    slowest = math.exp(-4 * (2 - math.sqrt(2)) * 0.5)
    check(0.5 * slowest <= damped[-1] / damped[0] <= 1.2 * slowest, 'damping: of the lowest mode', (damped, slowest))


def test_default_step():
    fine = run(SCENE, '--scene', 'chain', '--method', 'leapfrog', '--fps', '30', '--duration', '1')
    check(f'dt = {1 / 90:.16g}'[:18] in fine.stdout, 'whole steps a frame, below half the stable step', fine.stdout[:400])
    equal(table(SCENE, '--scene', 'chain', '--method', 'leapfrog', '--fps', '30', '--duration', '1', '--dt', float.hex(1 / 90)),
          parse(fine.stdout), 'a step in hexadecimal')
    pushed = run(SCENE, '--scene', 'chain', '--method', 'leapfrog', '--fps', '100', '--duration', '1', '--poke', '0,2,0,1,1')
    check('dt = 0.0025' in pushed.stdout and pushed.stderr == '', 'and below an eighth of a push', pushed.stdout[:400])
    loose = run(SCENE, '--scene', 'rope', '--stiffness', '0', '--method', 'leapfrog', '--duration', '1', '--fps', '64')
    rows = parse(loose.stdout)
    fallen = 9.81 / 0.2 * (1 - (1 - math.exp(-0.2)) / 0.2)  # drag/mass = 0.2/s
    check(loose.returncode == 0 and 'dt = 0.015625 s' in loose.stdout
          and abs(float(rows[-1]['max_displacement_m']) / fallen - 1) <= 1e-4,
          'without springs a step is a frame, and things fall', loose.stdout[-300:])


# --- pushes -----------------------------------------------------------------------------------------------------------

def test_pushes(folder):
    """Their momentum, by the profile that --help states; the sum over steps of sin^4 is exact to rounding."""
    def close(got, want, name):
        check(abs(got - want) <= 1e-9 * abs(want), name, (got, want))

    close(momentum(folder, '--poke', '0.03125,1.3,2.6,70,0.9', '--push-duration', '0.125'), -3 / 8 * 70 * 0.125, 'a poke')
    close(momentum(folder, '--poke', '0,1.3,2.6,-70,1e-9', '--push-duration', '0.125'), 3 / 8 * 70 * 0.125,
          'a poke between particles moves the nearest, and upwards where it pulls')
    close(momentum(folder, '--drop-box', '0.125,2.5'), -2.5 * math.sqrt(2 * 9.81), 'a box')
    close(momentum(folder, '--drop-box', '0.125,2.5', '--poke', '0,1,1,70,1', '--push-duration', '0.125'),
          -2.5 * math.sqrt(2 * 9.81) - 3 / 8 * 70 * 0.125, 'both')
    close(momentum(folder), -3 / 8 * 1e5 * 0.02, 'the poke that water gets anyway')
    drops = momentum(folder, '--rain', '200', '--duration', '2', '--fps', '32', '--push-duration', '0x1p-8') / -(1.3 * 10)
    # of a Poisson number of 400: all but one in 10^9 seeds are within 6 standard deviations; the last drops may still fall
    check(280 <= drops <= 520, 'rain: so many drops', drops)
    few = momentum(folder, '--rain', '4', '--duration', '2', '--fps', '32', '--push-duration', '0x1p-8') / -(1.3 * 10)
    check(few >= 1 and abs(few - round(few)) <= 1e-9, 'rain: each drop has its momentum', few)


def test_shapes_of_pushes(folder):
    """Free particles keep the speed that a push gave them, so their heights are in proportion to their shares."""
    def heights(*args):
        last = frames_of(folder, *FREE_WATER, '--size', '33', *args)[0]
        return {(int(r['i']), int(r['j'])): -float(r['z_m']) for r in last}

    def in_proportion(got, shares, name):
        total, sum_of_shares = sum(got.values()), sum(shares.values())
        worst = max(abs(got[place] / total - shares.get(place, 0) / sum_of_shares) for place in got)
        check(worst <= 1e-9, name, worst)

    inner = [(i, j) for i in range(1, 32) for j in range(1, 32)]
    at = {place: (place[0] / 8 - 1.3, place[1] / 8 - 2.6) for place in inner}
    round_shares = {place: max(0, 1 - (x * x + y * y) * math.pi / 0.9)**2 for place, (x, y) in at.items()}
    in_proportion(heights('--poke', '0,1.3,2.6,70,0.9'), round_shares, 'a poke is spread as said')
    middle = {(i, j): 1 for i in range(14, 19) for j in range(14, 19)}  # within 0.25 m, edges included
    in_proportion(heights('--drop-box', '0,3'), middle, 'a box is even, in the middle')
    drops = heights('--rain', '40', '--seed', '3')
    wet = [place for place, height in drops.items() if height > 0]
    check(any(i < 16 and j < 16 for i, j in wet) and any(i > 16 and j > 16 for i, j in wet)
          and any(i < 16 < j for i, j in wet) and any(j < 16 < i for i, j in wet), 'rain falls everywhere', sorted(wet))
    one = heights('--rain', '2', '--duration', '0.5', '--seed', '1')
    wet = [place for place, height in one.items() if height > 0]
    # a drop has the radius 0.25 m/sqrt(pi) = 1.13 spacings: at most 3 x 3 particles
    check(0 < len(wet) <= 9 * 4, 'a drop is small', wet)


def test_places_of_pushes(folder):
    last = frames_of(folder, *FREE_WATER, '--poke', '0,2,2,70,0.3')[0]
    moved = [(row['i'], row['j']) for row in last if float(row['z_m']) != 0]
    equal(moved, [('4', '4')], 'a small poke moves what is below it')
    edge = frames_of(folder, *FREE_WATER, '--poke', '0,0,0,70,1e-9')[0]
    equal([(row['i'], row['j']) for row in edge if float(row['z_m']) != 0], [('1', '1')], 'pinned particles take no part')


def test_rain():
    def rain(*args):
        return run(SCENE, '--scene', 'water', '--method', 'leapfrog', '--duration', '1', '--rain', '20', *args).stdout
    one = rain('--seed', '1')
    equal(parse(rain()), parse(one), 'rain: the same for the same seed, 1')
    check(parse(rain('--seed', '2')) != parse(one), 'rain: another seed, another rain')
    equal(parse(rain('--rain', '0')), parse(rain('--rain', '0', '--seed', '7')), 'no rain needs no seed')


# --- frames -----------------------------------------------------------------------------------------------------------

def test_frames(folder):
    where, positions = os.path.join(folder, 'frames'), os.path.join(folder, 'positions.tsv')
    args = ['--scene', 'jelly', '--size', '3', '--method', 'rk4', '--duration', '0.25', '--fps', '40', '--frames', where]
    first = run(SCENE, *args, '--positions', positions)
    names = [f'frame-{i:06}.tsv' for i in range(11)]

    def contents():
        texts = []
        for name in names:
            with open(os.path.join(where, name), encoding='ascii') as file:
                texts.append(file.read())
        return texts

    equal((first.returncode, sorted(os.listdir(where))), (0, names), 'frames: the files')
    texts = contents()
    rows = [parse(text) for text in texts]
    equal([len(frame) for frame in rows], [27] * 11, 'frames: a row for each particle')
    equal(list(rows[0][0]), 't_s particle i j k x_m y_m z_m'.split(), 'frames: columns')
    check(all(abs(float(frame[0]['t_s']) - i / 40) <= 1e-12 for i, frame in enumerate(rows)), 'frames: at their times',
          [frame[0]['t_s'] for frame in rows])
    check(all(int(r['particle']) == int(r['i']) + 3 * (int(r['j']) + 3 * int(r['k'])) for frame in rows for r in frame),
          'frames: places in the grid')
    equal({(r['x_m'], r['z_m']) for r in rows[-1] if (r['i'], r['k']) == ('1', '0')}, {('0.34999999999999998', '0')},
          'frames: what is pinned stays')
    with open(positions, encoding='ascii') as file:
        equal(parse(file.read()), [row for frame in rows for row in frame], 'frames: the same positions in one file')
    second = run(SCENE, *args)
    equal((second.returncode, second.stdout, contents()), (0, first.stdout.replace(' --positions FILE', ''),
                                                          [text.replace(' --positions FILE', '') for text in texts]),
          'frames: the same bytes again')
    check(where not in ''.join(texts) + first.stdout, 'frames: do not say where they are')
    shorter = run(SCENE, *args, '--duration', '0.1')
    check(shorter.returncode == 3 and '/frame-0000' in shorter.stderr and 'longer run' in shorter.stderr,
          'frames: of a longer run stay', shorter.stderr)
    os.remove(os.path.join(where, names[5]))
    gap = run(SCENE, *args, '--duration', '0.1')
    equal((gap.returncode, len(os.listdir(where))), (3, 10), 'frames: also behind a gap')
    nowhere = os.path.join(folder, 'no', 'such')
    for option in ('--output', '--positions'):
        lost = run(SCENE, *args, option, nowhere)
        equal((lost.returncode, len(os.listdir(where))), (3, 10), f'frames: stay where {option} cannot be written')
    slow = run(SCENE, *args, '--dt', '0.04', '--method', 'leapfrog')
    rows = [parse(text) for text in contents()]
    check(slow.returncode == 0 and [float(frame[0]['t_s']) for frame in rows[:4]] == [0, 0.04, 0.04, 0.08],
          'frames: with steps longer than they are, some show the same', [frame[0]['t_s'] for frame in rows])
    times = column(parse(slow.stdout), 't_s')
    equal(times, sorted(set(times)), 'rows: none twice')


def test_frames_that_cannot_be_written(folder):
    rope = ['--scene', 'rope', '--method', 'leapfrog', '--duration', '0.1']
    file = os.path.join(folder, 'file')
    with open(file, 'w', encoding='ascii') as stream:
        stream.write('older\n')
    for path in (os.path.join(folder, 'no', 'such'), file, 'x' * 300, 'x/' * 3000):
        result = run(SCENE, *rope, '--frames', path)
        check(result.returncode == 3 and result.stdout == '' and result.stderr.startswith(f'{SCENE}: --frames: '),
              f'frames: cannot write to {path[:30]}', result)
    with open(file, encoding='ascii') as stream:
        equal((stream.read(), os.listdir(folder)), ('older\n', ['file']), 'frames: nothing is left behind')


# --- explosions ---------------------------------------------------------------------------------------------------------

def test_explosion(folder):
    target, where = os.path.join(folder, 'rows.tsv'), os.path.join(folder, 'frames')
    args = ['--scene', 'water', '--method', 'euler', '--dt', '0.01', '--duration', '5', '-o', target, '--frames', where]
    result = run(SCENE, *args)
    with open(target, encoding='ascii') as file:
        rows = parse(file.read())
    remarks = result.stderr.splitlines()
    equal((result.returncode, len(remarks)), (1, 3), 'explosion: status 1')
    check('quarter of --push-duration' in remarks[1], 'explosion: a step that is long for a push is remarked on', remarks)
    check('not below the stable step of euler' in remarks[0] and ' 0.01 s' in remarks[0], 'explosion: the step is remarked on', remarks)
    time = float(remarks[2].partition(' t = ')[2].split()[0])
    check('blows up' in remarks[2] and 0 <= time - float(rows[-1]['t_s']) <= 1 / 60 + 0.01, 'explosion: the time is told',
          (remarks, rows[-1]))
    check(all(math.isfinite(float(x)) for row in rows for x in row.values()) and float(rows[-1]['energy_J']) > 1e290,
          'explosion: rows up to there', rows[-1])
    # every step multiplies an undamped mode by at most sqrt(1 + (omega dt)^2), omega^2 <= 24 k/m
    growth = math.log10(1 + 24 * 25000 * 0.01**2)
    check(time / 0.01 * growth >= 300, 'explosion: not before it can', time)
    fewer = len(os.listdir(where))
    check(100 < fewer < 200, 'explosion: frames up to there', fewer)
    steps = round(time / 0.01)
    equal([run(SCENE, *args[:-6], '--duration', f'{0.01 * n}').returncode for n in (steps - 1, steps)], [0, 1],
          'explosion: at that step and not before')
    for length in ('1e200', '1.35386709505176e+155'):
        lost = run(SCENE, '--scene', 'chain', '--method', 'leapfrog', '--length', length, '--stiffness', '1', '--drag', '100',
                   '--stretch', '1e9', '--dt', '0.01', '--duration', '0.02')
        equal((lost.returncode, parse(lost.stdout), 't = 0 s' in lost.stderr), (1, [], True), 'explosion: at the start')
    slow = ['--push-duration', '0.1']
    stable = run(SCENE, '--scene', 'water', '--method', 'rk4', '--dt', '0.00336', '--duration', '1', *slow)
    equal((stable.returncode, stable.stderr), (0, ''), 'below the stable step nothing is said')
    above = run(SCENE, '--scene', 'water', '--method', 'rk4', '--dt', '0.00337', '--duration', '1', *slow)
    check(above.returncode == 0 and '0.00336' in above.stderr, 'above it the step is told', above.stderr)
    chain = run(SCENE, '--scene', 'chain', '--method', 'euler', '--duration', '1')
    check(chain.returncode == 0 and 'no step is stable' in chain.stderr, 'without drag no step of Euler is stable', chain.stderr)


# --- the map ------------------------------------------------------------------------------------------------------------

def test_map():
    rows = table(MAP, '--quick')
    equal({(r['scene'], r['method']) for r in rows}, {(s, m) for s in SCENES for m in METHODS}, 'map: scenes and methods')
    equal({(r['scene'], (int(r['particles']), int(r['links']))) for r in rows}, set(SCENES.items()), 'map: sizes')
    check(all(abs(float(r['dt_s']) * int(r['substeps']) * 60 - 1) <= 1e-15 for r in rows), 'map: steps of a frame')
    for r in rows:
        name = f'map: {r["scene"]}, {r["method"]}, {r["substeps"]}'
        error = float(r['energy_error'])
        check((r['verdict'] == 'fine') == (error <= 0.05), f'{name}: the verdict', r)
        if r['method'] != 'euler' and float(r['dt_s']) < float(r['stable_step_s']):
            check(r['verdict'] not in ('exploded', 'gaining'), f'{name}: stable below the stable step', r)
        if r['method'] == 'euler' and r['scene'] != 'chain':
            equal(r['verdict'], 'exploded', f'{name}: Euler explodes')
    for scene in SCENES:
        shortest = [r for r in rows if r['scene'] == scene and r['substeps'] == '64' and r['method'] != 'euler']
        equal([r['verdict'] for r in shortest], ['fine', 'fine'], f'map: {scene}: short steps are fine')
    part = table(MAP, '--quick', '--scene', 'jelly', '--method', 'rk4')
    equal(part, [r for r in rows if (r['scene'], r['method']) == ('jelly', 'rk4')], 'map: a part is the part')


def test_time():
    """Which steps it times; how long they take is nobody's promise."""
    rows = table(MAP, '--quick', '--time', '--scene', 'rope')
    quick = table(MAP, '--quick', '--scene', 'rope')
    equal([r['method'] for r in rows], ['leapfrog', 'rk4'], 'time: methods that can be fine')
    for r in rows:
        verdicts = {int(q['substeps']): q['verdict'] for q in quick if q['method'] == r['method']}
        below = math.floor(1 / 60 / float(r['stable_step_s'])) + 1
        fewest = min(n for n in verdicts if n >= below and all(v == 'fine' for k, v in verdicts.items() if k >= n))
        equal(int(r['substeps']), fewest, f'time: {r["method"]}: the fewest steps that are fine and stable')
        check(abs(float(r['particles_per_ms']) * float(r['frame_ms']) / int(r['particles']) - 1) <= 1e-3, 'time: particles in a millisecond', r)


sys.exit(run_tests(globals()))
