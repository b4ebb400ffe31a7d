// SPDX-License-Identifier: MIT
// A block of jelly. Its six faces are smooth surfaces that share their edges. Light shines through thin parts.
import { BackSide, CylinderGeometry } from "three";

import { Upsampler } from "../surface.mjs";
import { floorAt, lighting, Lit, plain, shadowOf } from "./light.mjs";

const times = 3; // fine cells per cell
const plate = -0.05; // [m]

const flesh = /* glsl */ `
    ${lighting}
    varying vec3 n, v;
    uniform float inside;
    void main() {
        vec3 normal = normalize(n) * (inside > 0.5 ? -1.0 : 1.0), eye = normalize(v);
        float facing = clamp(dot(normal, eye), 0.0, 1.0);
        vec3 deep = vec3(0.80, 0.04, 0.12), thin = vec3(1.0, 0.34, 0.30);
        vec3 c = mix(thin, deep, 0.25 + 0.55 * facing);
        float back = max(dot(-normal, sun), 0.0), towards = 0.5 - 0.5 * dot(eye, sun);
        float through = back * back + 0.35 * towards * towards;
        vec3 glow = vec3(1.0, 0.22, 0.16) * (0.30 * through + 0.16);
        vec3 colour = lit(c, normal, eye, 0.75) * 0.8 + glow;
        gl_FragColor = inside > 0.5 ? vec4(0.7 * colour, 1.0) : vec4(colour, 0.70 + 0.25 * (1.0 - facing) * (1.0 - facing));
    }`;

const china = plain("0.16, 0.30, 0.46", 0.5);

// The points of the surface of a fine lattice, each once, and the indices of the points of each face.
function skinOf(fine) {
    const named = new Map();
    const name = (i, j, k) => {
        const key = i + fine * (j + fine * k);
        if (!named.has(key)) named.set(key, named.size);
        return named.get(key);
    };
    const index = [];
    const faces = [];
    for (const axis of [0, 1, 2])
        for (const end of [0, 1]) {
            const points = new Uint32Array(fine * fine);
            for (let b = 0; b < fine; b++)
                for (let a = 0; a < fine; a++) {
                    const p = [0, 0, 0];
                    p[axis] = end * (fine - 1);
                    p[(axis + 1) % 3] = a;
                    p[(axis + 2) % 3] = b;
                    points[a + fine * b] = name(...p);
                }
            for (let b = 0; b + 1 < fine; b++)
                for (let a = 0; a + 1 < fine; a++) {
                    const p = a + fine * b;
                    const [q, r, s] = [p + 1, p + fine, p + fine + 1];
                    const corners = end ? [p, q, r, q, s, r] : [p, r, q, q, r, s];
                    index.push(...corners.map((corner) => points[corner]));
                }
            faces.push({ axis, end, points });
        }
    return { points: named.size, index, faces };
}

export class Jelly extends Lit {
    static camera = { from: [0.72, -1.62, 0.98], to: [0, 0, 0.29], fit: 1.25 };

    constructor(info, theme) {
        const n = info.count[0];
        const upsampler = new Upsampler(n, times);
        const { points, index, faces } = skinOf(upsampler.fine);
        super(theme, points, index);
        Object.assign(this, { n, upsampler, faces, face: new Float32Array(upsampler.fine ** 2) });
        const side = info.length;
        this.group.position.set(-side / 2, -side / 2, 0);
        const shader = (inside) =>
            flesh.replace("uniform float inside;", `const float inside = ${inside}.0;`);
        const back = this.mesh(this.geometry, shader(1), { side: BackSide });
        const front = this.mesh(this.geometry, shader(0), { transparent: true });
        front.renderOrder = 1;
        const dish = this.mesh(new CylinderGeometry(0.86 * side, 0.72 * side, 0.045, 72), china);
        const dishShadow = shadowOf(dish.geometry, plate);
        for (const each of [dish, dishShadow]) {
            each.rotation.x = Math.PI / 2;
            each.position.set(side / 2, side / 2, -0.0235);
        }
        const below = floorAt(plate, this.uniforms, 1.6);
        below.position.set(side / 2, side / 2, plate);
        this.group.add(back, front, dish, below, dishShadow, shadowOf(this.geometry, -0.0005, 0.25));
    }

    update({ positions }) {
        const { n, upsampler, face } = this;
        const strides = [1, n, n * n];
        for (const { axis, end, points } of this.faces) {
            const first = end * (n - 1) * strides[axis];
            const a = strides[(axis + 1) % 3];
            const b = strides[(axis + 2) % 3];
            for (let k = 0; k < 3; k++) {
                upsampler.run((i, j) => positions[3 * (first + a * i + b * j) + k], face);
                for (let p = 0; p < face.length; p++) this.position.array[3 * points[p] + k] = face[p];
            }
        }
        this.moved();
    }
}
