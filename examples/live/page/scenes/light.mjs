// SPDX-License-Identifier: MIT
// Common parts of cloth, rope and jelly: one sun, a sky, a floor that fades out, and shadows on it.
import {
    BufferAttribute,
    BufferGeometry,
    CircleGeometry,
    DoubleSide,
    DynamicDrawUsage,
    EqualStencilFunc,
    Group,
    IncrementStencilOp,
    Mesh,
    ShaderMaterial,
    Vector3,
} from "three";

import { smoothNormals } from "../surface.mjs";

export const sun = new Vector3(-0.45, -0.55, 0.75).normalize();

/** The light from a surface of a colour, with normal n and direction v towards the eye; gloss from 0 to 1. */
export const lighting = /* glsl */ `
    uniform vec3 skyLow, skyHigh, ground;
    const vec3 sun = vec3(${sun.toArray().map((x) => x.toFixed(4))});
    vec3 lit(vec3 colour, vec3 n, vec3 v, float gloss) {
        float day = max(dot(n, sun), 0.0);
        vec3 above = mix(vec3(dot(skyHigh, vec3(0.3333))), skyHigh, 0.35);
        vec3 round = mix(0.45 * ground + 0.34, 0.40 * above + 0.42, 0.5 + 0.5 * n.z);
        vec3 h = normalize(sun + v);
        float sharp = mix(8.0, 220.0, gloss);
        float glint = gloss * (0.15 + 2.0 * gloss) * exp2(1.5 * sharp * (dot(n, h) - 1.0)) * step(0.0, dot(n, sun));
        float rim = 1.0 - clamp(dot(n, v), 0.0, 1.0);
        rim *= rim;
        rim *= rim;
        vec3 mirror = mix(ground, mix(skyLow, skyHigh, 0.5), 0.5 + 0.5 * reflect(-v, n).z);
        return colour * (0.62 * round + 0.14 * clamp(dot(n, v), 0.0, 1.0) + 0.72 * day * vec3(1.0, 0.95, 0.86)) + glint + mirror * rim * (0.10 + 0.5 * gloss);
    }`;

/** The vertex shader for geometries with positions, normals and uv. */
export const vertex = /* glsl */ `
    varying vec3 n, v;
    varying vec2 at;
    void main() {
        vec4 p = modelMatrix * vec4(position, 1.0);
        n = mat3(modelMatrix) * normal;
        v = cameraPosition - p.xyz;
        at = uv;
        gl_Position = projectionMatrix * viewMatrix * p;
    }`;

/** The fragment shader for one colour, given as three numbers in text; gloss as in lit(). */
export function plain(colour, gloss) {
    return /* glsl */ `
    ${lighting}
    varying vec3 n, v;
    void main() { gl_FragColor = vec4(lit(vec3(${colour}), normalize(n), normalize(v), ${gloss.toFixed(2)}), 1.0); }`;
}

/** What cloth, rope and jelly have in common: a light, and a surface of moving points. */
export class Lit {
    group = new Group();
    geometry = new BufferGeometry();
    uniforms = { skyLow: {}, skyHigh: {}, ground: {} };

    /** index: of the triangles, an attribute or a list */
    constructor(theme, points, index) {
        this.paint(theme);
        this.position = new BufferAttribute(new Float32Array(3 * points), 3).setUsage(DynamicDrawUsage);
        this.normal = new BufferAttribute(new Float32Array(3 * points), 3).setUsage(DynamicDrawUsage);
        this.geometry.setAttribute("position", this.position);
        this.geometry.setAttribute("normal", this.normal);
        this.geometry.setIndex(index);
    }

    /** A mesh of this light. */
    mesh(geometry, fragmentShader, more = {}) {
        const { uniforms } = this;
        const mesh = new Mesh(
            geometry,
            new ShaderMaterial({ uniforms, vertexShader: vertex, fragmentShader, ...more }),
        );
        mesh.frustumCulled = geometry !== this.geometry;
        return mesh;
    }

    /** Call it when points have moved. */
    moved(triangles = this.geometry.index.array) {
        smoothNormals(this.position.array, triangles, this.normal.array);
        this.position.needsUpdate = this.normal.needsUpdate = true;
    }

    paint(theme) {
        for (const name of Object.keys(this.uniforms)) this.uniforms[name].value = theme[name];
    }

    look() {}
    dispose() {}
}

export function floorAt(z, uniforms, radius = 4) {
    const material = new ShaderMaterial({
        uniforms,
        transparent: true,
        depthWrite: false,
        vertexShader: vertex,
        fragmentShader: /* glsl */ `
            ${lighting}
            varying vec2 at;
            void main() {
                float away = 2.0 * length(at - 0.5);
                gl_FragColor = vec4(ground, 0.9 * (1.0 - smoothstep(0.35, 1.0, away)));
            }`,
    });
    const mesh = new Mesh(new CircleGeometry(radius, 48), material);
    mesh.position.z = z;
    mesh.renderOrder = -2;
    return mesh;
}

/** The shadow of a geometry on the floor. The stencil prevents darkening a pixel twice. */
export function shadowOf(geometry, z, strength = 0.2) {
    const material = new ShaderMaterial({
        transparent: true,
        depthWrite: false,
        side: DoubleSide,
        stencilWrite: true,
        stencilFunc: EqualStencilFunc,
        stencilRef: 0,
        stencilZPass: IncrementStencilOp,
        vertexShader: /* glsl */ `
            varying float high;
            void main() {
                vec4 p = modelMatrix * vec4(position, 1.0);
                high = max(p.z - ${(z + 0.004).toFixed(3)}, 0.0);
                p.xy -= vec2(${(sun.x / sun.z).toFixed(4)}, ${(sun.y / sun.z).toFixed(4)}) * high;
                p.z = ${(z + 0.004).toFixed(3)};
                gl_Position = projectionMatrix * viewMatrix * p;
            }`,
        fragmentShader: /* glsl */ `
            varying float high;
            void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, ${strength.toFixed(2)} * exp(-0.15 * high)); }`,
    });
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = -1;
    return mesh;
}
