/* SPDX-License-Identifier: MIT */
/*
 * Bending stiffness of rods, grids and meshes, against the theory of beams and plates. Energies and forces of weighted
 * links with rest length 0 are written here from their definition in scene.h.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <springstep/scene.h>

#include "check.h"

enum { most = 700, most_bends = 4 * most };

static const double pi = 3.14159265358979323846;

/* Particles with links that bend. */
typedef struct body {
    size_t particles, bends;
    double position[3 * most];
    uint8_t pinned[most];
    spring_weighted_link bend[most_bends];
} body;

static body b; /* of the current test */

/* --------------------------------------------------------------------------------- small motion across rod or sheet */

/* The stiffness matrix of one coordinate of the free particles, and its Cholesky factor. */
typedef struct matrix {
    size_t n;
    size_t particle[most]; /* of each row */
    double k[most][most];
} matrix;

static matrix m;

static void assemble(void)
{
    size_t row[most];
    m.n = 0;
    for (size_t i = 0; i < b.particles; i++)
        if (!b.pinned[i]) {
            m.particle[m.n] = i;
            row[i] = m.n++;
        }
    for (size_t i = 0; i < m.n; i++)
        memset(m.k[i], 0, m.n * sizeof m.k[i][0]);
    for (size_t l = 0; l < b.bends; l++) {
        const spring_weighted_link *w = &b.bend[l];
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                if (w->weight[i] != 0 && w->weight[j] != 0 && !b.pinned[w->particle[i]] && !b.pinned[w->particle[j]])
                    m.k[row[w->particle[i]]][row[w->particle[j]]] += w->stiffness * w->weight[i] * w->weight[j];
    }
    for (size_t i = 0; i < m.n; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = m.k[i][j];
            for (size_t k = 0; k < j; k++)
                sum -= m.k[i][k] * m.k[j][k];
            CHECK(i != j || sum > 0, "positive definite");
            m.k[i][j] = i == j ? sqrt(sum) : sum / m.k[j][j];
        }
}

/* From forces on particles to displacements. */
static void solve(double *f)
{
    double y[most];
    for (size_t i = 0; i < m.n; i++) {
        y[i] = f[m.particle[i]];
        for (size_t k = 0; k < i; k++)
            y[i] -= m.k[i][k] * y[k];
        y[i] /= m.k[i][i];
    }
    for (size_t i = m.n; i-- > 0;) {
        for (size_t k = i + 1; k < m.n; k++)
            y[i] -= m.k[k][i] * y[k];
        y[i] /= m.k[i][i];
        f[m.particle[i]] = y[i];
    }
}

/* The least eigenvalue of K x = value A x, by inverse iteration. */
static double least_eigenvalue(void (*apply)(const double *x, double *y))
{
    double x[most], y[most], norm = 0;
    for (size_t i = 0; i < b.particles; i++)
        x[i] = b.pinned[i] ? 0 : random_uniform(0.5, 1);
    for (int it = 0; it < 60; it++) {
        apply(x, y);
        solve(y);
        norm = 0;
        for (size_t i = 0; i < b.particles; i++) {
            y[i] = b.pinned[i] ? 0 : y[i];
            norm = fmax(norm, fabs(y[i]));
        }
        for (size_t i = 0; i < b.particles; i++)
            x[i] = y[i] / norm;
    }
    return 1 / norm; /* the largest element of x was 1 */
}

/* ------------------------------------------------------------------------------------------------------------ rods */

static const double rigidity = 0.013, rod_length = 1.3; /* [N m^2], [m] */

/* A straight rod in a random direction. clamped: the segment before the rod is between pinned particles. */
static void make_rod(uint32_t segments, bool clamped, double jitter, uint32_t axes)
{
    double h[most], sum = 0, x = 0, direction[3], norm = 0;
    for (uint32_t i = 0; i < segments; i++)
        sum += h[i] = 1 + random_uniform(-jitter, jitter);
    for (uint32_t a = 0; a < axes; a++) {
        direction[a] = random_uniform(0.2, 1);
        norm += direction[a] * direction[a];
    }
    b.particles = segments + 1 + clamped;
    for (uint32_t i = 0; i < b.particles; i++) {
        for (uint32_t a = 0; a < axes; a++)
            b.position[i * axes + a] = 0.3 + x * direction[a] / sqrt(norm);
        x += rod_length / sum * (!clamped ? h[i < segments ? i : 0] : h[i == 0 ? 0 : i - 1]);
        b.pinned[i] = clamped ? i < 2 : i == 0 || i == segments;
    }
    b.bends = most_bends;
    CHECK(spring_bend_rod(b.particles, axes, b.position, b.pinned, rigidity, 0.02, b.bend, &b.bends) == SPRING_OK &&
              b.bends == segments - !clamped,
          "each particle with two neighbours");
}

static double deflection_of_cantilever(uint32_t segments, double jitter, uint32_t axes)
{
    double f[most] = {0};
    make_rod(segments, true, jitter, axes);
    assemble();
    f[b.particles - 1] = 1;
    solve(f);
    return f[b.particles - 1] / (pow(rod_length, 3) / (3 * rigidity));
}

static void deflection_of_rods(void)
{
    double error[3];
    for (int i = 0; i < 3; i++)
        error[i] = deflection_of_cantilever(10u << i, 0, 3) - 1;
    CHECK_BELOW(fabs(error[1]), 0.0013, "as scene.h says, with 20 segments");
    CHECK_CLOSE(log2(error[0] / error[1]), 2, 0.1, "order 2");
    CHECK_CLOSE(log2(error[1] / error[2]), 2, 0.1, "order 2");
    for (int i = 0; i < 20; i++)
        CHECK_BELOW(fabs(deflection_of_cantilever(40, 0.4, 2 + (uint32_t)i % 2) - 1), 0.001, "unequal segments");
}

static double spacing_of_rod(void)
{
    return rod_length / 20;
}

static void multiply_by_mass(const double *x, double *y) /* per length 1 */
{
    for (size_t i = 0; i < b.particles; i++)
        y[i] = x[i] * spacing_of_rod() * (i + 1 == b.particles ? 0.5 : 1);
}

static void multiply_by_slopes(const double *x, double *y) /* a compressive force of 1 N */
{
    for (size_t i = 0; i < b.particles; i++)
        y[i] = (2 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < b.particles ? x[i + 1] : 0)) / spacing_of_rod();
}

static void frequency_and_buckling(void)
{
    make_rod(20, true, 0, 3);
    assemble();
    const double theory = pow(1.8751040687 / rod_length, 2) * sqrt(rigidity);
    CHECK_CLOSE(sqrt(least_eigenvalue(multiply_by_mass)) / theory, 1, 0.0022, "the first mode of a cantilever");
    make_rod(20, false, 0, 3);
    assemble();
    CHECK_CLOSE(least_eigenvalue(multiply_by_slopes) / (pow(pi / rod_length, 2) * rigidity), 1, 0.0022,
                "the load at which a rod on two hinges buckles");
}

/* ------------------------------------------------------------------------------------------ rods that bend very far */

/* The force on each particle of a rod whose segments have the stiffness `k` [N/m], in the plane. */
static void add_forces(const double *rest, double k, double (*f)[2])
{
    double(*x)[2] = (double(*)[2])b.position;
    for (size_t i = 0; i + 1 < b.particles; i++) {
        const double d[2] = {x[i + 1][0] - x[i][0], x[i + 1][1] - x[i][1]}, length = hypot(d[0], d[1]);
        for (int a = 0; a < 2; a++) {
            f[i][a] += k * (length - rest[i]) * d[a] / length;
            f[i + 1][a] -= k * (length - rest[i]) * d[a] / length;
        }
    }
    for (size_t l = 0; l < b.bends; l++)
        for (int a = 0; a < 2; a++) {
            const spring_weighted_link *w = &b.bend[l];
            double d = 0;
            for (int i = 0; i < 3; i++)
                d += w->weight[i] * x[w->particle[i]][a];
            for (int i = 0; i < 3; i++)
                f[w->particle[i]][a] -= w->weight[i] * w->stiffness * d;
        }
}

/* Finds the equilibrium with a force on the last particle, by steps with unequal masses that stop at each turn of the
   motion. */
static void settle(double load_y)
{
    static double rest[most], v[most][2], f[most][2];
    double(*x)[2] = (double(*)[2])b.position;
    for (size_t i = 0; i + 1 < b.particles; i++)
        rest[i] = hypot(x[i + 1][0] - x[i][0], x[i + 1][1] - x[i][1]);
    const double k = 300 * rigidity / pow(rest[1], 3) * rest[1] * rest[1] * 20;
    const double row = 4 * k + 4 * b.bend[1].stiffness;
    double residual = INFINITY;
    memset(v, 0, sizeof v);
    for (int it = 0; it < 4000000 && residual > 1e-5 * load_y; it++) {
        double power = 0;
        memset(f, 0, sizeof f);
        add_forces(rest, k, f);
        f[b.particles - 1][1] += load_y;
        residual = 0;
        for (size_t i = 2; i < b.particles; i++)
            for (int a = 0; a < 2; a++) {
                residual = fmax(residual, fabs(f[i][a]));
                v[i][a] += 1.6 / row * f[i][a];
                power += v[i][a] * f[i][a];
            }
        if (power < 0)
            memset(v, 0, sizeof v);
        for (size_t i = 2; i < b.particles; i++)
            for (int a = 0; a < 2; a++)
                x[i][a] += v[i][a];
    }
    CHECK(residual <= 1e-5 * load_y, "it comes to rest");
}

/* A rod along x, with particles 0 and 1 at the clamp, after a force across it. */
static void load_rod(double load)
{
    make_rod(20, true, 0, 2);
    for (size_t i = 0; i < b.particles; i++) {
        b.position[2 * i] = ((double)i - 1) * spacing_of_rod();
        b.position[2 * i + 1] = 0;
    }
    settle(load * rigidity / (rod_length * rod_length));
}

/* Where the tip of a rod that only bends is, [rod_length], from theta'' = -load cos theta along the rod. */
static void elastica(double load, double tip[2])
{
    double low = 0, high = pi / 2;
    const int steps = 2000;
    const double h = 1. / steps;
    for (int it = 0; it < 60; it++) {
        double theta = (low + high) / 2, slope = 0;
        tip[0] = tip[1] = 0;
        for (int i = 0; i < steps; i++) { /* leapfrog; tip: sums at the midpoints */
            slope -= h / 2 * load * cos(theta);
            theta += h / 2 * slope;
            tip[0] += h * cos(theta);
            tip[1] += h * sin(theta);
            theta += h / 2 * slope;
            slope -= h / 2 * load * cos(theta);
        }
        *(theta > 0 ? &high : &low) = (low + high) / 2;
    }
}

static void large_deflection(void)
{
    const double loads[] = {1, 2, 5, 10};
    for (int i = 0; i < 4; i++) {
        double tip[2];
        elastica(loads[i], tip);
        load_rod(loads[i]);
        for (int a = 0; a < 2; a++)
            CHECK_CLOSE(b.position[2 * b.particles - 2 + (size_t)a] / rod_length, tip[a], 0.003,
                        "the elastica, with 20 segments");
    }
    for (int i = 0; i < 3; i++) {
        const double load = pow(10, -5 + 2 * i);
        double tip[2];
        elastica(load, tip);
        load_rod(load);
        CHECK_CLOSE(b.position[2 * b.particles - 1] / rod_length / tip[1], 1.0013, 1e-4,
                    "linear in the force over four decades, as the elastica");
    }
}

/* ---------------------------------------------------------------------------------------------------------- sheets */

static double energy_of(const spring_weighted_link *l, const double *z)
{
    double d = 0;
    for (int i = 0; i < 4; i++)
        d += l->weight[i] == 0 ? 0 : l->weight[i] * z[l->particle[i]];
    return 0.5 * l->stiffness * d * d;
}

/* Constant curvatures k1 and k2, the first in the direction of an angle. */
static void bend_sheet(double k1, double k2, double angle, double *z)
{
    for (size_t i = 0; i < b.particles; i++) {
        const double *x = &b.position[3 * i];
        const double u = cos(angle) * x[0] + sin(angle) * x[1], v = cos(angle) * x[1] - sin(angle) * x[0];
        z[i] = k1 * u * u / 2 + k2 * v * v / 2;
    }
}

static void make_grid(uint32_t nx, uint32_t ny, double h, uint32_t families, double d, bool clamped)
{
    const spring_grid g = {.count = {nx, ny}, .spacing = h};
    size_t links;
    CHECK(spring_grid_size(&g, &b.particles, &links) == SPRING_OK && b.particles <= most, "fits");
    spring_grid_fill(&g, b.position, b.pinned, NULL);
    for (size_t i = 0; i < b.particles; i++)
        b.pinned[i] = clamped && i % nx < 2;
    b.bends = most_bends;
    CHECK(spring_bend_grid(&g, b.pinned, families, d, 0.02, b.bend, &b.bends) == SPRING_OK, "a sheet");
}

enum { rows = SPRING_BEND_ROWS, plate = SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS };

/* Elements around one inner particle have the energy of its cell; forces on particles that only inner elements reach are
   0. */
static void constant_curvature(void)
{
    enum { n = 9, middle = n / 2 * n + n / 2 };
    double z[most], f[most];
    for (int i = 0; i < 8 * 20; i++) {
        const double h = random_log(0.01, 10), d = random_log(1e-6, 10), k1 = 1, k2 = i < 8 ? 0 : random_uniform(-1, 1);
        const double angle = i < 8 ? i * pi / 8 : random_uniform(0, pi);
        const bool diagonals = i % 16 < 8;
        make_grid(n, n, h, diagonals ? plate : rows, d, false);
        bend_sheet(k1, k2, angle, z);
        double energy = 0;
        memset(f, 0, sizeof f);
        for (size_t l = 0; l < b.bends; l++) {
            const spring_weighted_link *w = &b.bend[l];
            const double moved =
                w->weight[0] * z[w->particle[0]] - z[w->particle[1]] + w->weight[2] * z[w->particle[2]];
            energy += w->particle[1] == middle ? energy_of(w, z) : 0;
            for (int j = 0; j < 3; j++)
                f[w->particle[j]] -= w->weight[j] * w->stiffness * moved;
            CHECK_BITS(w->damping, 0.02 * w->stiffness, "damping_time times the stiffness");
        }
        const double c2 = pow(cos(angle), 2), s2 = 1 - c2, xx = k1 * c2 + k2 * s2, yy = k1 * s2 + k2 * c2;
        const double theory = diagonals ? k1 * k1 + k2 * k2 + 2. / 3 * k1 * k2 : xx * xx + yy * yy;
        CHECK_CLOSE(energy / (d / 2 * theory * h * h), 1, 1e-10, "a plate of Poisson ratio 1/3; 0 along rows");
        for (size_t y = 2; y < n - 2; y++)
            for (size_t x = 2; x < n - 2; x++)
                CHECK_BELOW(fabs(f[y * n + x]) / (d * (fabs(k1) + fabs(k2))), 1e-10, "no force inside");
    }
}

/* A sheet that is clamped at x = 0, with a load along its end: deflection/(F L^3/(3 D width)). */
static double deflection_of_sheet(double d)
{
    double f[most] = {0}, length = 0, low = INFINITY, high = -INFINITY, mean = 0, sum = 0;
    for (size_t i = 0; i < b.particles; i++) {
        length = fmax(length, b.position[3 * i]);
        low = fmin(low, b.position[3 * i + 1]);
        high = fmax(high, b.position[3 * i + 1]);
    }
    double start = 0;
    for (size_t i = 0; i < b.particles; i++)
        start = b.pinned[i] ? fmax(start, b.position[3 * i]) : start;
    for (size_t i = 0; i < b.particles; i++)
        if (b.position[3 * i] > length * (1 - 1e-9)) {
            const double y = b.position[3 * i + 1];
            f[i] = y < low + 1e-9 || y > high - 1e-9 ? 0.5 : 1;
            sum += f[i];
        }
    double share[most];
    for (size_t i = 0; i < b.particles; i++)
        share[i] = f[i] /= sum;
    assemble();
    solve(f);
    for (size_t i = 0; i < b.particles; i++)
        mean += share[i] * f[i];
    return mean / (pow(length - start, 3) / (3 * d * (high - low)));
}

static void cantilever_sheets(void)
{
    const double d = 3e-4;
    for (uint32_t n = 10; n <= 20; n *= 2) {
        make_grid(n + 2, n + 1, 0.3 / n, rows, d, true);
        CHECK_CLOSE(deflection_of_sheet(d), 1, 0.52 / (n * n), "a beam, order 2");
        make_grid(n + 2, n + 1, 0.3 / n, plate, d, true);
        CHECK_CLOSE(deflection_of_sheet(d), 1 + 0.125 / 2, 0.125 / 2, "between a wide plate and a beam");
    }
    make_grid(22, 4, 0.015, plate, d, true);
    CHECK_CLOSE(deflection_of_sheet(d), 1.2, 0.02, "a strip of four particles is softer, as scene.h says");
}

/* ---------------------------------------------------------------------------------------------------------- meshes */

typedef enum mesh_kind { ONE_DIAGONAL, ALTERNATING, EQUILATERAL, JITTERED } mesh_kind;

static uint32_t triangle[6 * most];

static size_t make_mesh(uint32_t nx, uint32_t ny, double h, mesh_kind kind)
{
    size_t count = 0;
    b.particles = nx * ny;
    for (uint32_t j = 0; j < ny; j++)
        for (uint32_t i = 0; i < nx; i++) {
            double *x = &b.position[3 * (j * nx + i)];
            x[0] = h * (i + (kind == EQUILATERAL ? 0.5 * (j & 1) : 0));
            x[1] = h * (kind == EQUILATERAL ? sqrt(0.75) : 1) * j;
            x[2] = 0;
            if (kind == JITTERED && i > 1 && i + 1 < nx && j > 0 && j + 1 < ny) {
                x[0] += h * random_uniform(-0.25, 0.25);
                x[1] += h * random_uniform(-0.25, 0.25);
            }
            b.pinned[j * nx + i] = i < 2;
            if (i + 1 == nx || j + 1 == ny)
                continue;
            const uint32_t at = j * nx + i, q[4] = {at, at + 1, at + nx, at + nx + 1};
            const bool falling = kind == ALTERNATING ? ((i + j) & 1) != 0 : kind == EQUILATERAL && (j & 1) == 0;
            const uint32_t corners[6] = {q[0], q[1], falling ? q[2] : q[3], falling ? q[1] : q[0], q[3], q[2]};
            memcpy(&triangle[count], corners, sizeof corners);
            count += 6;
        }
    return count / 3;
}

static void bend_mesh(size_t triangles, double d)
{
    static uint32_t work[most + 12 * most + 1];
    b.bends = most_bends;
    CHECK(spring_bend_mesh(b.particles, b.position, triangles, triangle, b.pinned, d, 0.02, b.bend, &b.bends, work) ==
              SPRING_OK,
          "a mesh");
}

/* The energy per area of a sheet with constant curvatures, in the mean over inner particles, each with half of its edges,
   /(D/2). */
static double energy_density(uint32_t nx, uint32_t ny, double area, double d, double k1, double k2, double angle)
{
    double z[most], sum = 0;
    bend_sheet(k1, k2, angle, z);
    for (size_t l = 0; l < b.bends; l++)
        for (int i = 0; i < 2; i++) {
            const uint32_t x = b.bend[l].particle[i] % nx, y = b.bend[l].particle[i] / nx;
            sum += x >= 3 && x + 3 < nx && y >= 3 && y + 3 < ny ? energy_of(&b.bend[l], z) / 2 : 0;
        }
    return sum / ((nx - 6) * (ny - 6) * area) / (d / 2);
}

static void meshes(void)
{
    const double d = 3e-4, stiffest[] = {3, 1.5, 1, 4};
    for (int kind = ONE_DIAGONAL; kind <= JITTERED; kind++) {
        size_t triangles;
        for (uint32_t n = 10; n <= 20; n *= 2) {
            triangles = make_mesh(n + 2, n + 1, 0.3 / n, (mesh_kind)kind);
            bend_mesh(triangles, d);
            CHECK_CLOSE(deflection_of_sheet(d), kind == JITTERED ? 1.08 : 1.11, kind == JITTERED ? 0.13 : 0.1,
                        "a beam bends less by up to 21 %; an irregular mesh may be stiffer by a few percent");
        }
        triangles = make_mesh(26, 26, 0.3, (mesh_kind)kind);
        memset(b.pinned, 0, b.particles);
        bend_mesh(triangles, d);
        const double area = 0.09 * (kind == EQUILATERAL ? sqrt(0.75) : 1);
        double most_density = 0;
        for (int i = 0; i < 8; i++)
            most_density = fmax(most_density, energy_density(26, 26, area, d, 1, 0, i * pi / 8));
        if (kind == JITTERED) {
            CHECK_CLOSE(most_density, stiffest[kind], 0.5, "about as scene.h says");
            continue;
        }
        CHECK_CLOSE(most_density, stiffest[kind], 1e-10, "the stiffest direction that scene.h names");
        const double poisson = kind == EQUILATERAL ? -1. / 3 : 0;
        CHECK_CLOSE(energy_density(26, 26, area, d, 1, 1, 0), 2 * (1 + poisson), 1e-10, "a sphere");
        CHECK_CLOSE(energy_density(26, 26, area, d, 1, -1, 0), 2 * (1 - poisson), 1e-10, "a saddle");
    }
}

int main(void)
{
    static const test tests[] = {
        {"deflection of rods", deflection_of_rods}, {"frequency and buckling", frequency_and_buckling},
        {"large deflection", large_deflection},     {"constant curvature", constant_curvature},
        {"cantilever sheets", cantilever_sheets},   {"meshes", meshes},
    };
    return RUN_TESTS("bend", tests);
}
