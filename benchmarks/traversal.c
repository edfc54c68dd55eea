/* Plain grid traversal (Amanatides and Woo, 1987): the yardstick of benchmarks/raycast.py.
   One ray after the other, one cell after the other; exact to the cell's edge. */
#include <math.h>
#include <stdint.h>

static double traverse(const uint8_t *occupied, int64_t rows, int64_t columns,
                       double x, double y, double dx, double dy, double reach)
{
    int64_t i = (int64_t)floor(x), j = (int64_t)floor(y);
    int64_t step_i = dx < 0 ? -1 : 1, step_j = dy < 0 ? -1 : 1;
    double per_x = dx != 0 ? fabs(1 / dx) : INFINITY, per_y = dy != 0 ? fabs(1 / dy) : INFINITY;
    double next_x = dx != 0 ? (dx < 0 ? x - i : i + 1 - x) * per_x : INFINITY;
    double next_y = dy != 0 ? (dy < 0 ? y - j : j + 1 - y) * per_y : INFINITY;
    double t = 0;
    while (i >= 0 && i < columns && j >= 0 && j < rows && t < reach) {
        if (occupied[j * columns + i]) return t;
        if (next_x < next_y) { t = next_x; next_x += per_x; i += step_i; }
        else                 { t = next_y; next_y += per_y; j += step_j; }
    }
    return reach;
}

void cast(const uint8_t *occupied, int64_t rows, int64_t columns, const double *pose, int64_t M,
          const double *angles, int64_t K, double reach, double *lengths)
{
    for (int64_t m = 0; m < M; m++)
        for (int64_t k = 0; k < K; k++) {
            double direction = pose[2 * M + m] + angles[k];
            lengths[k * M + m] = traverse(occupied, rows, columns, pose[m], pose[M + m],
                                          cos(direction), sin(direction), reach);
        }
}
