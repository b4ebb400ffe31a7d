// SPDX-License-Identifier: MIT
// Random springs, the same in every run: a 32-bit xorshift generator.

let state = 2463534242;

export function bits() {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return state >>> 0;
}

export const uniform = (from, to) => from + ((to - from) * bits()) / 4294967296;
export const logarithmic = (from, to) => Math.exp(uniform(Math.log(from), Math.log(to)));
export const chance = (share) => uniform(0, 1) < share;

/** Of user interfaces: 0.02 to 50 Hz, damping ratio 0.1 to 10, a tenth of them critical or nearly so. */
export function usual() {
    const omega = 2 * Math.PI * logarithmic(0.02, 50);
    const zeta = chance(0.1) ? 1 + (bits() % 3) * 1e-9 : logarithmic(0.1, 10);
    const mass = chance(0.5) ? 1 : logarithmic(0.1, 10);
    return { mass, stiffness: mass * omega * omega, damping: 2 * zeta * mass * omega, omega, zeta };
}

/** Of any size, denormal, 0, or with quotients that overflow. */
export function extreme() {
    const size = () =>
        chance(0.1) ? 0 : chance(0.1) ? logarithmic(1e-323, 1e-300) : 10 ** uniform(-300, 300);
    const stiffness = size();
    const mass = chance(0.3) ? 1 : chance(0.5) ? size() || 1 : stiffness * 10 ** uniform(-6, 6) || 1;
    const critical = 2 * Math.sqrt(stiffness) * Math.sqrt(mass);
    const damping = chance(0.3) ? size() : critical * (chance(0.2) ? 1 : 10 ** uniform(-3, 3));
    const omega = Math.sqrt(stiffness / mass);
    return { mass, stiffness, damping, omega, zeta: damping / critical };
}

/** The decay rate of the slowest mode. */
export const slowRate = (omega, zeta) =>
    omega * (zeta <= 1 ? zeta : 1 / (zeta + Math.sqrt(zeta - 1) * Math.sqrt(zeta + 1)));
