// SPDX-License-Identifier: MIT
// Ropes, sheets and soft bodies, softer links, and the pieces of torn scenes.
import { define, checkArray, checkCount, checkKnown, lendLinks, linkBytes, linksAt } from "./definition.js";
import { borrowed, library, memory } from "./module.js";
import { check, checkNotNegative, checkPositive, isNumber } from "./options.js";

const families = { structural: 1, shear: 2, bend: 4 };
const faces = { firstX: 1, lastX: 2, firstY: 4, lastY: 8, firstZ: 16, lastZ: 32 };

function bitsOf(name, list, known) {
    checkArray(name, list);
    let bits = 0;
    const words = `a list of ${Object.keys(known).join(", ")}`;
    for (const word of list) {
        check(Object.hasOwn(known, word), name, words, word, TypeError);
        bits |= known[word];
    }
    return bits;
}

const options = "count axes height spacing stretch families stiffness damping pinned".split(" ");

/** Positions, pins and links of a grid, as a part of a definition. */
export function grid(definition) {
    checkKnown("definition", definition, options);
    const { count, height = false, axes = height ? 1 : 3, spacing, stretch = 1 } = definition;
    const { stiffness, damping = 0, families: linked = ["structural"], pinned = [] } = definition;
    checkArray("count", count);
    check([1, 2, 3].includes(count.length), "count.length", "1, 2 or 3", count.length);
    const [x, y = 1, z = 1] = count;
    [x, y, z].forEach((each, i) => checkCount(`count[${i}]`, each, 1));
    check([1, 2, 3].includes(axes), "axes", "1, 2 or 3", axes);
    const positive = { spacing, stretch };
    for (const [name, value] of Object.entries(positive)) checkPositive(name, value);
    for (const [name, value] of Object.entries({ stiffness, damping })) checkNotNegative(name, value);
    if (height) check(axes === 1, "axes", "1 for a height field", axes);
    else
        [x, y, z].forEach((each, i) =>
            check(each === 1 || i < axes, `count[${i}]`, `1 with ${axes} axes`, each),
        );
    const bits = [bitsOf("families", linked, families), bitsOf("pinned", pinned, faces)];
    return borrowed((take) => {
        const size = take(8);
        const { grid_begin, grid_fill } = library();
        const all = x * y * z;
        const fits = all < 2 ** 32;
        const status = fits
            ? grid_begin(x, y, z, axes, height, spacing, stretch, bits[0], stiffness, damping, bits[1], size)
            : 1;
        check(status === 0, "count", "small enough for 32-bit indices", [x, y, z], RangeError);
        const [particles, links] = memory.uint32(size, 2);
        const position = take(8 * particles * axes);
        const pins = take(particles);
        const link = take(linkBytes * links);
        grid_fill(position, pins, link);
        const made = {
            axes,
            count: [x, y, z],
            position: memory.float64(position, particles * axes).slice(),
            pinned: memory.uint8(pins, particles).slice(),
            links: linksAt(link, links),
        };
        if (height) {
            made.component = 2;
            made.base = Float32Array.from({ length: 3 * particles }, (_, k) => {
                const i = Math.floor(k / 3);
                return [i % x, Math.floor(i / x) % y, 0][k % 3] * spacing;
            });
        }
        return made;
    });
}

/** Triangles of a sheet, or of the surface of a solid: counterclockwise from outside, or from the positive side of a sheet. */
export function triangles(count) {
    const strides = [1, count[0], count[0] * count[1]];
    const indices = [];
    const face = (start, u, v) => {
        for (let j = 0; j < count[v] - 1; j++)
            for (let i = 0; i < count[u] - 1; i++) {
                const a = start + i * strides[u] + j * strides[v];
                const c = a + strides[u] + strides[v];
                indices.push(a, a + strides[u], c, a, c, a + strides[v]);
            }
    };
    for (let axis = 0; axis < 3; axis++) {
        const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        face((count[axis] - 1) * strides[axis], u, v);
        if (count[axis] > 1) face(0, v, u);
    }
    return Uint32Array.from(indices);
}

/** From 0 to 1 along x and y. */
export function textureCoordinates([x, y, z]) {
    const coordinates = new Float32Array(2 * x * y * z);
    for (let k = 0; k < x * y * z; k++) {
        coordinates[2 * k] = (k % x) / Math.max(1, x - 1);
        coordinates[2 * k + 1] = (Math.floor(k / x) % y) / Math.max(1, y - 1);
    }
    return coordinates;
}

/** The links of a definition, with less stiffness where leapfrog would need steps shorter than dt. */
export function soften(definition, dt, fraction = 0.5) {
    checkPositive("dt", dt);
    check(isNumber(fraction) && fraction > 0 && fraction <= 1, "fraction", "a number > 0 and <= 1", fraction);
    return borrowed((take) => {
        const { linkPointer, links } = define(take, definition);
        const status = library().def_soften(dt, fraction, linkPointer);
        check(status === 0, "dt", "short enough for weightedLinks, which keep their stiffness", dt);
        return linksAt(linkPointer, links);
    });
}

/** The connected components of particles and links. */
export function components(particles, links) {
    checkCount("particles", particles, 1);
    return borrowed((take) => {
        const [pointer, number] = lendLinks(take, links);
        const result = take(4 * particles);
        const count = library().spring_links_components(particles, number, pointer, result);
        check(count > 0, "links", `valid links between ${particles} particles`, links, RangeError);
        return { count, component: memory.uint32(result, particles).slice() };
    });
}
