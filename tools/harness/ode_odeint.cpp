// SPDX-License-Identifier: MIT
// Steppers of Boost.odeint; see ode.h. Small states are arrays of fixed size, as usual with odeint, so that the
// compiler unrolls the loops of a step. Larger states are vectors.
#include <algorithm>
#include <array>
#include <boost/version.hpp>
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_m4_mclachlan.hpp> // needs the one before
#include <exception>
#include <vector>

extern "C" {
#include "harness/ode.h"
}

namespace odeint = boost::numeric::odeint;

namespace
{

template <std::size_t n> using Array = std::array<double, n>;

void set_size(std::vector<double> &state, std::size_t size)
{
    state.assign(size, 0);
}

template <std::size_t n> void set_size(Array<n> &state, std::size_t)
{
    state.fill(0);
}

template <class State> struct Derivative {
    ode *o;

    void operator()(const State &y, State &dy, double t) const
    {
        o->evaluations++;
        o->derivative(t, y.data(), dy.data(), o->data);
    }
};

// Sets up a stepper and copies the state, outside of the measured time.
template <class Stepper, class State> void begin(ode *o, const double *y, Stepper &stepper, State &state)
{
    set_size(state, o->size);
    std::copy(y, y + o->size, state.begin());
    stepper.adjust_size(state);
    ode_start_clock(o);
}

template <class State> void end(ode *o, double *y, const State &state)
{
    ode_stop_clock(o);
    std::copy(state.begin(), state.end(), y);
}

struct Fehlberg {
    double h;
    uint64_t n;

    template <class State> const char *integrate(ode *o, double *y) const
    {
        odeint::runge_kutta_fehlberg78<State> stepper;
        State state;
        begin(o, y, stepper, state);
        for (uint64_t i = 0; i < n; i++)
            stepper.do_step(Derivative<State>{o}, state, double(i) * h, h);
        end(o, y, state);
        o->steps += n;
        return nullptr;
    }
};

struct BulirschStoer {
    double duration, tolerance;

    // The loop of odeint's integrate_adaptive(), which does not count steps or report a reason.
    template <class State>
    static const char *loop(ode *o, double duration, odeint::bulirsch_stoer<State> &stepper, State &state)
    {
        const int most_failures = 500; // in a row, as odeint has it
        double t = 0, h = 1e-3 * duration;
        for (int failures = 0; t < duration && failures < most_failures;) {
            h = std::min(h, duration - t);
            if (!(t + h > t))
                return "odeint: the step is too short";
            const bool done = stepper.try_step(Derivative<State>{o}, state, t, h) == odeint::success;
            failures = done ? 0 : failures + 1;
            o->steps += done ? 1 : 0;
        }
        return t < duration ? "odeint: no step is accepted" : nullptr;
    }

    template <class State> const char *integrate(ode *o, double *y) const
    {
        // One tolerance for all components. Position errors times omega are about as large as velocity errors, so the
        // larger of the magnitudes bounds both.
        const double largest = *std::max_element(o->scale, o->scale + o->size);
        odeint::bulirsch_stoer<State> stepper(tolerance * largest, 0);
        State state;
        begin(o, y, stepper, state);
        const char *message = loop(o, duration, stepper, state);
        end(o, y, state);
        return message;
    }
};

struct McLachlan {
    double h;
    uint64_t n;

    // The derivative has positions and velocities in one array, odeint in two.
    template <class Half> struct Acceleration {
        ode *o;
        double *y, *dy;

        void operator()(const Half &x, Half &dv) const
        {
            o->evaluations++;
            std::copy(x.begin(), x.end(), y);
            o->derivative(0, y, dy, o->data);
            std::copy(dy + x.size(), dy + 2 * x.size(), dv.begin());
        }
    };

    template <class Half> const char *integrate(ode *o, double *y) const
    {
        odeint::symplectic_rkn_sb3a_m4_mclachlan<Half> stepper;
        const std::size_t half = o->size / 2;
        std::vector<double> together(y, y + o->size), derivative(o->size);
        Half x, v;
        set_size(x, half);
        set_size(v, half);
        std::copy(y, y + half, x.begin());
        std::copy(y + half, y + o->size, v.begin());
        stepper.adjust_size(x);
        const Acceleration<Half> acceleration{o, together.data(), derivative.data()};
        ode_start_clock(o);
        for (uint64_t i = 0; i < n; i++)
            stepper.do_step(acceleration, x, v, double(i) * h, h);
        ode_stop_clock(o);
        o->steps += n;
        std::copy(x.begin(), x.end(), y);
        std::copy(v.begin(), v.end(), y + half);
        return nullptr;
    }
};

// Selects the type of the state by its size. No exception leaves this file.
template <class Method> const char *integrate(const Method &method, std::size_t numbers, ode *o, double *y)
{
    try {
        switch (numbers) {
        case 1:
            return method.template integrate<Array<1>>(o, y);
        case 2:
            return method.template integrate<Array<2>>(o, y);
        case 4:
            return method.template integrate<Array<4>>(o, y);
        case 6:
            return method.template integrate<Array<6>>(o, y);
        case 12:
            return method.template integrate<Array<12>>(o, y);
        default:
            return method.template integrate<std::vector<double>>(o, y);
        }
    } catch (const std::exception &) {
        return "odeint: an exception";
    }
}

} // namespace

const char *ode_odeint_rkf78(ode *o, double *y, double h, uint64_t n)
{
    return integrate(Fehlberg{h, n}, o->size, o, y);
}

const char *ode_odeint_bulirsch_stoer(ode *o, double *y, double duration, double tolerance)
{
    return integrate(BulirschStoer{duration, tolerance}, o->size, o, y);
}

const char *ode_odeint_sb3a_m4(ode *o, double *y, double h, uint64_t n)
{
    return integrate(McLachlan{h, n}, o->size / 2, o, y);
}

const char *ode_odeint_version()
{
    return BOOST_LIB_VERSION; // "1_74"
}
