// SPDX-License-Identifier: MIT
// A cloth that hangs on two of its corners. Cells with torn links lose their triangles.
import { BufferAttribute, CylinderGeometry, DoubleSide, DynamicDrawUsage, SphereGeometry } from "three";

import { floorAt, lighting, Lit, plain, shadowOf } from "./light.mjs";

const floor = -3.35; // [m]

const fabric = /* glsl */ `
    ${lighting}
    varying vec3 n, v;
    varying vec2 at;
    void main() {
        vec3 normal = normalize(n) * (gl_FrontFacing ? 1.0 : -1.0);
        vec2 p = at * 6.0, cell = abs(fract(p) - 0.5);
        float diamond = smoothstep(0.30, 0.33, cell.x + cell.y);
        vec2 q = abs(fract(p + 0.5) - 0.5);
        float dot2 = 1.0 - smoothstep(0.10, 0.13, q.x + q.y);
        vec3 red = gl_FrontFacing ? vec3(0.78, 0.14, 0.17) : vec3(0.52, 0.09, 0.14), cream = vec3(0.97, 0.90, 0.78);
        vec3 c = mix(red, mix(red * 0.82, cream, 0.9), max(dot2, (1.0 - diamond) * 0.25));
        vec2 edge = min(at, 1.0 - at);
        c = mix(cream, c, smoothstep(0.022, 0.028, min(edge.x, edge.y)));
        vec2 thread = 0.5 + 0.5 * cos(at * 6.2831853 * 150.0);
        c *= 0.96 + 0.04 * thread.x * thread.y;
        gl_FragColor = vec4(lit(c, normal, normalize(v), 0.06), 1.0);
    }`;

const metal = plain("0.55, 0.50, 0.44", 0.7);

// The triangles of the cells, and the links along their sides.
function weave(columns, rows, ends) {
    const particles = columns * rows;
    const named = new Map();
    for (let l = 0; l < ends.length / 2; l++) named.set(ends[2 * l] * particles + ends[2 * l + 1], l);
    const link = (a, b) => named.get(Math.min(a, b) * particles + Math.max(a, b));
    const triangles = [];
    for (let j = 0; j + 1 < rows; j++)
        for (let i = 0; i + 1 < columns; i++) {
            const a = i + columns * j;
            const b = a + 1;
            const c = a + columns;
            const d = c + 1;
            triangles.push({ corners: [a, b, c], sides: [link(a, b), link(a, c)] });
            triangles.push({ corners: [b, d, c], sides: [link(b, d), link(c, d)] });
        }
    return triangles;
}

export class Cloth extends Lit {
    static camera = { from: [1.5, -5.0, -0.75], to: [0, 0.2, -1.42], fit: 1.1 };

    constructor(info, theme) {
        const [columns, rows] = info.count;
        const triangles = weave(columns, rows, info.ends);
        const index = new BufferAttribute(new Uint32Array(3 * triangles.length), 1);
        super(theme, info.particles, index.setUsage(DynamicDrawUsage));
        this.triangles = triangles;
        this.torn = 0;
        const uv = Float32Array.from({ length: 2 * info.particles }, (_, k) => {
            const p = k >> 1;
            return k % 2 ? Math.floor(p / columns) / (rows - 1) : (p % columns) / (columns - 1);
        });
        this.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
        this.stitch(new Uint8Array(info.links));

        this.group.position.set(-info.length / 2, 0, 0);
        const bar = this.mesh(new CylinderGeometry(0.025, 0.025, info.length + 0.7, 16), metal);
        const barShadow = shadowOf(bar.geometry, floor);
        for (const each of [bar, barShadow]) {
            each.rotation.z = Math.PI / 2;
            each.position.set(info.length / 2, 0, 0.045);
        }
        const cloth = this.mesh(this.geometry, fabric, { side: DoubleSide });
        this.group.add(cloth, bar, shadowOf(this.geometry, floor), barShadow);
        for (const x of [0, info.length]) {
            const ring = this.mesh(new SphereGeometry(0.05, 20, 14), metal);
            ring.position.set(x, 0, 0.02);
            this.group.add(ring);
        }
        const ground = floorAt(floor, this.uniforms);
        ground.position.x = info.length / 2;
        this.group.add(ground);
    }

    stitch(cut) {
        const { index } = this.geometry;
        let at = 0;
        for (const { corners, sides } of this.triangles)
            if (!sides.some((side) => cut[side])) for (const corner of corners) index.array[at++] = corner;
        this.geometry.setDrawRange(0, at);
        this.drawn = index.array.subarray(0, at);
        index.needsUpdate = true;
    }

    update({ positions, torn }) {
        const many = torn.reduce((sum, each) => sum + each, 0);
        if (many !== this.torn) this.stitch(torn);
        this.torn = many;
        this.position.array.set(positions);
        this.moved(this.drawn);
    }
}
