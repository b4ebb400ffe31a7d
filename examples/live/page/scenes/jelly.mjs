// SPDX-License-Identifier: MIT
// A block of jelly. Its six faces are smooth surfaces that share their edges. Light shines through thin parts.
import {
    BackSide,
    BufferAttribute,
    BufferGeometry,
    CylinderGeometry,
    DynamicDrawUsage,
    FrontSide,
    Group,
    Mesh,
    ShaderMaterial,
} from "three";

import { smoothNormals, Upsampler } from "../surface.mjs";
import { floorAt, lighting, plain, shadowOf, uniformsOf, vertex } from "./light.mjs";

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

export class Jelly {
    static camera = { from: [0.72, -1.62, 0.98], to: [0, 0, 0.29], fit: 1.25 };

    constructor(info, theme) {
        const n = info.count[0];
        const uniforms = uniformsOf(theme);
        this.uniforms = uniforms;
        this.n = n;
        this.upsampler = new Upsampler(n, times);
        this.buildSkin(this.upsampler.fine);
        const side = info.length;
        this.group = new Group();
        this.group.position.set(-side / 2, -side / 2, 0);
        const skin = (inside) =>
            new ShaderMaterial({
                uniforms: { ...uniforms, inside: { value: inside } },
                vertexShader: vertex,
                fragmentShader: flesh,
                side: inside ? BackSide : FrontSide,
                transparent: !inside,
            });
        this.skins = [new Mesh(this.geometry, skin(1)), new Mesh(this.geometry, skin(0))];
        for (const mesh of this.skins) mesh.frustumCulled = false;
        this.skins[1].renderOrder = 1;
        const dish = new Mesh(
            new CylinderGeometry(0.86 * side, 0.72 * side, 0.045, 72),
            new ShaderMaterial({ uniforms, vertexShader: vertex, fragmentShader: china }),
        );
        dish.rotation.x = Math.PI / 2;
        dish.position.set(side / 2, side / 2, -0.0235);
        const below = floorAt(plate, uniforms, 1.6);
        below.position.set(side / 2, side / 2, plate);
        const dishShadow = shadowOf(dish.geometry, plate);
        dishShadow.rotation.copy(dish.rotation);
        dishShadow.position.copy(dish.position);
        this.group.add(...this.skins, dish, below, dishShadow, shadowOf(this.geometry, -0.0005, 0.25));
    }

    // The points of the surface of a fine lattice, each once, and the indices of the points of each face.
    buildSkin(fine) {
        const named = new Map();
        const name = (i, j, k) => {
            const key = i + fine * (j + fine * k);
            if (!named.has(key)) named.set(key, named.size);
            return named.get(key);
        };
        const index = [];
        this.faces = [];
        for (const axis of [0, 1, 2])
            for (const end of [0, 1]) {
                const place = (a, b) => {
                    const p = [0, 0, 0];
                    p[axis] = end * (fine - 1);
                    p[(axis + 1) % 3] = a;
                    p[(axis + 2) % 3] = b;
                    return name(...p);
                };
                const points = new Uint32Array(fine * fine);
                for (let b = 0; b < fine; b++)
                    for (let a = 0; a < fine; a++) points[a + fine * b] = place(a, b);
                for (let b = 0; b + 1 < fine; b++)
                    for (let a = 0; a + 1 < fine; a++) {
                        const [p, q, r, s] = [
                            a + fine * b,
                            a + 1 + fine * b,
                            a + fine * (b + 1),
                            a + 1 + fine * (b + 1),
                        ];
                        const corners = end ? [p, q, r, q, s, r] : [p, r, q, q, r, s];
                        index.push(...corners.map((corner) => points[corner]));
                    }
                this.faces.push({ axis, end, points });
            }
        this.geometry = new BufferGeometry();
        this.position = new BufferAttribute(new Float32Array(3 * named.size), 3).setUsage(DynamicDrawUsage);
        this.normal = new BufferAttribute(new Float32Array(3 * named.size), 3).setUsage(DynamicDrawUsage);
        this.geometry.setAttribute("position", this.position);
        this.geometry.setAttribute("normal", this.normal);
        this.geometry.setIndex(index);
        this.index = this.geometry.index.array;
        this.face = new Float32Array(fine * fine);
    }

    paint(theme) {
        for (const name of ["skyLow", "skyHigh", "ground"]) {
            this.uniforms[name].value = theme[name];
            for (const mesh of this.skins) mesh.material.uniforms[name].value = theme[name];
        }
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
        smoothNormals(this.position.array, this.index, this.normal.array);
        this.position.needsUpdate = this.normal.needsUpdate = true;
    }

    look() {}
    dispose() {}
}
