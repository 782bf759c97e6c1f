/* Time loops as one would write them by hand, with ghost cells: the yardstick of tests/benchmarks/loops.py.
   Build with -O3 -march=native -ffp-contract=off.

   u: two buffers of n + 2*G cells with G ghost cells at each end; records the largest (u - u_0)^2 and the least u every
   `every` steps. */
#include <math.h>

#define G 2
#define LOOP(NAME, ARGUMENTS, BODY)                                                                                    \
    void NAME(double *w, const double *start, long n, double dt, long steps, long every, double *dist, double *u_min,  \
              double *scratch, const double *r, ARGUMENTS)                                                             \
    {                                                                                                                  \
        double *restrict u = w + G, *restrict un = w + n + 3 * G, *restrict q = scratch + G;                           \
        (void)q;                                                                                                       \
        for (long step = 1; step <= steps; step++) {                                                                   \
            periodic(u, n);                                                                                            \
            BODY                                                                                                       \
            double *swap = u; u = un; un = swap;                                                                       \
            if (step % every == 0) record(u, start, n, dist + step / every, u_min + step / every);                     \
        }                                                                                                              \
    }

static void periodic(double *u, long n)
{
    for (long k = 1; k <= G; k++) { u[-k] = u[n - k]; u[n + k - 1] = u[k - 1]; }
}

static void record(const double *u, const double *start, long n, double *dist, double *u_min)
{
    double largest = 0, least = u[0];
    for (long j = 0; j < n; j++) {
        double d = u[j] - start[j];
        largest = d * d > largest ? d * d : largest;
        least = u[j] < least ? u[j] : least;
    }
    *dist = sqrt(largest);
    *u_min = least;
}

/* u_t = nu u_xx - u u_x */
LOOP(burgers, double nu,
    for (long j = 0; j < n; j++) {
        double u_x = (u[j + 1] - u[j - 1]) * r[0];
        double u_xx = (u[j + 1] - 2 * u[j] + u[j - 1]) * r[1];
        un[j] = u[j] + dt * (nu * u_xx - u[j] * u_x);
    })

/* u_t = -u_xxxx - u_xx - u u_x */
LOOP(kuramoto_sivashinsky, double unused,
    (void)unused;
    for (long j = 0; j < n; j++) {
        double u_x = (u[j + 1] - u[j - 1]) * r[0];
        double u_xx = (u[j + 1] - 2 * u[j] + u[j - 1]) * r[1];
        double u_xxxx = (6 * u[j] - 4 * u[j + 1] - 4 * u[j - 1] + u[j + 2] + u[j - 2]) * r[2];
        un[j] = u[j] + dt * (-u_xxxx - u_xx - u[j] * u_x);
    })

/* u_t = (u^3 - u - g u_xx)_xx, the bracket first */
LOOP(cahn_hilliard, double g,
    for (long j = 0; j < n; j++) {
        double u_xx = (u[j + 1] - 2 * u[j] + u[j - 1]) * r[1];
        q[j] = u[j] * u[j] * u[j] - u[j] - g * u_xx;
    }
    periodic(q, n);
    for (long j = 0; j < n; j++) un[j] = u[j] + dt * ((q[j + 1] - 2 * q[j] + q[j - 1]) * r[1]);)
