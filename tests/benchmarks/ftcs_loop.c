/* The paper's scheme for the toy system with ghost cells, as plain C: the yardstick of tests/benchmarks/kernel.py.
   Build with -O3 -march=native -ffp-contract=off. */
#include <math.h>

/* w: two buffers of u and v, each with n + 2 cells; records Dist and min u every `every` steps, counting from 0. */
void march(double *w, const double *sin_x, const double *u_inf, long n, double r1, double r2, double dt, double eps,
           long steps, long every, double *dist, double *u_min)
{
    double *restrict u = w, *restrict v = w + (n + 2), *restrict un = w + 2 * (n + 2), *restrict vn = w + 3 * (n + 2);
    for (long step = 1; step <= steps; step++) {
        u[0] = u[n]; u[n + 1] = u[1]; v[0] = v[n]; v[n + 1] = v[1];
        for (long j = 1; j <= n; j++) {
            double u_x = (u[j + 1] - u[j - 1]) * r1, v_x = (v[j + 1] - v[j - 1]) * r1;
            double v_xx = (v[j + 1] - 2 * v[j] + v[j - 1]) * r2;
            un[j] = u[j] + dt * v_x;
            vn[j] = v[j] + dt * (eps * u[j] * v_xx + u_x - v[j] - sin_x[j]);
        }
        double *swap = u; u = un; un = swap;
        swap = v; v = vn; vn = swap;
        if (step % every == 0) {
            double largest = 0, least = u[1];
            for (long j = 1; j <= n; j++) {
                double du = u[j] - u_inf[j], d2 = du * du + v[j] * v[j];
                largest = d2 > largest ? d2 : largest;
                least = u[j] < least ? u[j] : least;
            }
            dist[step / every] = sqrt(largest);
            u_min[step / every] = least;
        }
    }
}
