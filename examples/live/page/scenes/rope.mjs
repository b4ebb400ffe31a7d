// SPDX-License-Identifier: MIT
// A rope held at one end, drawn as a tube along a Catmull-Rom curve through its particles. A heavy end is an iron ball.
import { BufferAttribute, SphereGeometry } from "three";

import { floorAt, lighting, Lit, plain, shadowOf } from "./light.mjs";

const floor = -2.55; // [m]
const radius = 0.032; // [m]
const around = 10;
const along = 6; // rings per link

const strands = /* glsl */ `
    ${lighting}
    varying vec3 n, v;
    varying vec2 at;
    void main() {
        float twist = fract(at.x * 3.0 + at.y * 9.0), groove = min(twist, 1.0 - twist);
        vec3 c = mix(vec3(0.42, 0.29, 0.15), vec3(0.86, 0.69, 0.44), smoothstep(0.0, 0.28, groove));
        float fibre = fract(at.x * 21.0 + at.y * 63.0);
        c *= 0.92 + 0.08 * smoothstep(0.2, 0.5, min(fibre, 1.0 - fibre));
        gl_FragColor = vec4(lit(c, normalize(n), normalize(v), 0.05), 1.0);
    }`;

const iron = plain("0.17, 0.18, 0.21", 0.75);

export class Rope extends Lit {
    static camera = { from: [0.4, -5.0, -0.55], to: [0.0, 0, -0.92], fit: 1.1 };

    constructor(info, theme) {
        const rings = (info.particles - 1) * along + 1;
        const index = [];
        for (let r = 0; r + 1 < rings; r++)
            for (let a = 0; a < around; a++) {
                const p = r * (around + 1) + a;
                const q = p + around + 1;
                index.push(p, q, p + 1, p + 1, q, q + 1);
            }
        super(theme, rings * (around + 1), index);
        Object.assign(this, { particles: info.particles, rings });
        const uv = new Float32Array(2 * rings * (around + 1));
        for (let r = 0; r < rings; r++)
            for (let a = 0; a <= around; a++)
                uv.set([a / around, (r / (rings - 1)) * 2], 2 * (r * (around + 1) + a));
        this.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
        const ball = (size) => this.mesh(new SphereGeometry(size, 32, 22), iron);
        this.end = ball(info.massRatio > 1 ? 0.26 : 0.06);
        this.endShadow = shadowOf(this.end.geometry, floor);
        this.group.add(this.mesh(this.geometry, strands), this.end, ball(0.07));
        this.group.add(floorAt(floor, this.uniforms), shadowOf(this.geometry, floor), this.endShadow);
    }

    update({ positions }) {
        const n = this.particles;
        const x = this.position.array;
        const point = (i, axis) => positions[3 * Math.max(0, Math.min(n - 1, i)) + axis];
        for (let r = 0; r < this.rings; r++) {
            const cell = Math.min(Math.floor(r / along), n - 2);
            const t = r / along - cell;
            const c = [0, 2].map((axis) => {
                const [p, q, u, w] = [-1, 0, 1, 2].map((k) => point(cell + k, axis));
                const place =
                    q + 0.5 * t * (u - p + t * (2 * p - 5 * q + 4 * u - w + t * (3 * (q - u) + w - p)));
                const slope =
                    0.5 * (u - p + t * (2 * (2 * p - 5 * q + 4 * u - w) + 3 * t * (3 * (q - u) + w - p)));
                return [place, slope];
            });
            const size = Math.hypot(c[0][1], c[1][1]) || 1;
            const across = [-c[1][1] / size, c[0][1] / size]; // in the plane; the other direction is y
            for (let a = 0; a <= around; a++) {
                const angle = (2 * Math.PI * a) / around;
                const at = 3 * (r * (around + 1) + a);
                const u = radius * Math.cos(angle);
                x[at] = c[0][0] + u * across[0];
                x[at + 1] = radius * Math.sin(angle);
                x[at + 2] = c[1][0] + u * across[1];
            }
        }
        this.moved();
        const { array } = this.normal; // the seam: the first and last point of a ring coincide
        for (let r = 0; r < this.rings; r++)
            for (let axis = 0; axis < 3; axis++) {
                const a = 3 * r * (around + 1) + axis;
                array[a] = array[a + 3 * around] = array[a] + array[a + 3 * around];
            }
        this.end.position.fromArray(positions, 3 * (n - 1));
        this.endShadow.position.copy(this.end.position);
    }
}
