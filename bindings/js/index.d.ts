// SPDX-License-Identifier: MIT

/** The parameters of T, and no others. */
type Only<T> = T & { [K in Exclude<Names, keyof T>]?: never };
type Names =
    | ("stiffness" | "damping" | "mass" | "response" | "dampingFraction")
    | ("duration" | "bounce" | "hertz" | "dampingRatio" | "halfLife");

/** Parameters of a spring, in one of five forms. Times are in seconds. */
export type SpringParameters =
    | Only<{
          /** >= 0 */
          stiffness: number;
          /** >= 0 */
          damping: number;
          /** > 0; default 1 */
          mass?: number;
      }>
    | Only<{
          /** 2 pi / undamped angular frequency; > 0 */
          response: number;
          /** damping ratio, >= 0; default 1, which does not overshoot */
          dampingFraction?: number;
      }>
    | Only<{
          /** 2 pi / undamped angular frequency; > 0; default 0.5 */
          duration?: number;
          /** -1 to 1; default 0, which does not overshoot. 1 never stops. */
          bounce?: number;
      }>
    | Only<{
          /** undamped frequency, > 0 */
          hertz: number;
          /** >= 0; default 1, which does not overshoot */
          dampingRatio?: number;
      }>
    | Only<{
          /** time in which the amplitude halves; > 0 */
          halfLife: number;
          /** > 0; default 1, which does not overshoot */
          dampingRatio?: number;
      }>;

interface Tolerances {
    /** A value settles if its distance from the target is at most this; default 1/10000 of the size of the motion. */
    restDelta?: number;
    /** A value settles if its speed per second is at most this; default 1/1000 of the size of the motion. */
    restSpeed?: number;
}

export type SpringsOptions = SpringParameters & Tolerances & { clamp?: never; onRest?: never };

export type SpringOptions = SpringParameters &
    Tolerances & {
        /** see Spring.clamp; default false */
        clamp?: boolean;
        /** see Spring.onRest; default null */
        onRest?: ((spring: Spring) => void) | null;
    };

/** A value that follows a target. Bad input throws a RangeError or TypeError and changes nothing. */
export declare class Spring {
    /** At rest on its target `value`, which is 0 by default. The default options are `{ duration: 0.5 }`. */
    constructor(value?: number, options?: SpringOptions);

    readonly value: number;

    /** Velocity, in units of the value per second. Set it when a gesture ends, for example. */
    velocity: number;

    /** Target. A new target keeps value and velocity. */
    target: number;

    /** Whether the value is at rest on its target. step() has no effect then. A new target makes it false until a step. */
    readonly settled: boolean;

    /** Stop at the target instead of overshooting, however long the step. A value on its target stays there. */
    clamp: boolean;

    /** Called by step() when the spring settles: once for each new target or velocity, also if the target equals the value. */
    onRest: ((spring: Spring) => void) | null;

    /** Places value and target at `value`, at rest. Does not call onRest. */
    jump(value: number): void;

    /**
     * Advances by `dt` seconds, of any length, and returns the value. A negative `dt` integrates backwards. Value and velocity are bit-identical to those of
     * spring_follow() in C. If they would overflow, step() throws a RangeError and changes nothing. A settled spring stays
     * at rest on its target.
     */
    step(dt: number): number;
}

/** Many values with the same parameters, each with its own target. */
export declare class Springs {
    /** Values, velocities and targets are 0. The default options are `{ duration: 0.5 }`. */
    constructor(count: number, options?: SpringsOptions);

    readonly target: Float64Array;
    readonly value: Float64Array;
    readonly velocity: Float64Array;

    /**
     * Advances by `dt` seconds, of any length, and returns the number of values that still move. If a target is not finite or
     * a value would overflow, that value keeps its state, the others are advanced, and step() throws a RangeError.
     */
    step(dt: number): number;
}
