/* The bound of the benchmark: the whole filter in C, float32, one thread, arrays by component.
 * Plain loops that a compiler can vectorise (cc -O3 -march=native -ffast-math); bearings by the
 * cosine and sine of the angle difference would avoid atan2f, here it is vectorised instead. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static const float TWO_PI = 6.283185307f;

static inline uint32_t next(uint32_t *s) { /* xorshift32, one stream per lane */
    uint32_t x = *s;
    x ^= x << 13, x ^= x >> 17, x ^= x << 5;
    return *s = x;
}

/* Two normal numbers for each of M lanes, by Box and Muller. */
static void normals(int M, uint32_t *restrict s, float *restrict a, float *restrict b) {
    for (int i = 0; i < M; i++) {
        float u = (float)((next(&s[i]) >> 9) + 1) * 0x1p-23f;
        float t = (float)(next(&s[i]) >> 9) * 0x1p-23f * TWO_PI;
        float r = sqrtf(-2.0f * logf(u));
        a[i] = r * cosf(t), b[i] = r * sinf(t);
    }
}

static void predict(int M, const float *p, float *restrict x, float *restrict y,
                    float *restrict th, const float *restrict a, const float *restrict b) {
    const float v0 = p[0], w0 = p[1], dt = p[2], sv = p[3], sw = p[4];
    for (int i = 0; i < M; i++) {
        float d = (v0 + sv * a[i]) * dt, half = 0.5f * (w0 + sw * b[i]) * dt;
        float h2 = half * half, chord = d * (1.0f - h2 * (1.0f / 6 - h2 * (1.0f / 120)));
        float c = th[i] + half;
        x[i] += chord * cosf(c), y[i] += chord * sinf(c), th[i] = c + half;
    }
}

static void weigh(int M, int L, const float *p, const float *lm, const float *z,
                  const float *restrict x, const float *restrict y, const float *restrict th,
                  float *restrict lw) {
    const float ir = 1.0f / p[5], ip = 1.0f / p[6];
    for (int k = 0; k < L; k++) {
        const float lx = lm[k], ly = lm[L + k], r = z[k], phi = z[L + k];
        for (int i = 0; i < M; i++) {
            float dx = lx - x[i], dy = ly - y[i];
            float er = (r - sqrtf(dx * dx + dy * dy)) * ir;
            float e = phi - atan2f(dy, dx) + th[i];
            e = (e - TWO_PI * rintf(e * (1.0f / TWO_PI))) * ip;
            lw[i] -= 0.5f * (er * er + e * e);
        }
    }
}

static void resample(int M, const float *restrict w, double total, float u, float *x, float *y,
                     float *th, float *restrict x1, float *restrict y1, float *restrict t1) {
    double edge = w[0] / total * M;
    int j = 0;
    for (int i = 0; i < M; i++) {
        while (i + u > edge && j < M - 1) edge += w[++j] / total * M;
        x1[i] = x[j], y1[i] = y[j], t1[i] = th[j];
    }
}

void run(int M, int L, int T, int seed, const float *p, const float *lm, const float *z,
         float *path) {
    float *all = malloc(sizeof(float) * 10 * M);
    uint32_t *s = malloc(sizeof(uint32_t) * M);
    float *x = all, *y = x + M, *th = y + M, *x1 = th + M, *y1 = x1 + M, *t1 = y1 + M;
    float *a = t1 + M, *b = a + M, *lw = b + M, *w = lw + M;
    uint32_t g = 2463534242u ^ (uint32_t)seed * 2654435761u;
    for (int i = 0; i < M; i++) s[i] = next(&g) * 2654435761u | 1u, lw[i] = 0;
    for (int k = 0; k < 8; k++) normals(M, s, a, b);
    for (int i = 0; i < M; i++) x[i] = p[7] + p[10] * a[i], y[i] = p[8] + p[11] * b[i];
    normals(M, s, a, b);
    for (int i = 0; i < M; i++) th[i] = p[9] + p[12] * a[i];
    for (int t = 0; t < T; t++) {
        normals(M, s, a, b);
        predict(M, p, x, y, th, a, b);
        weigh(M, L, p, lm, z + 2 * L * t, x, y, th, lw);
        float peak = lw[0];
        for (int i = 1; i < M; i++) peak = lw[i] > peak ? lw[i] : peak;
        float sum = 0, squares = 0, mx = 0, my = 0, mc = 0, ms = 0;
        for (int i = 0; i < M; i++) {
            float wi = expf(lw[i] - peak);
            w[i] = wi, lw[i] -= peak, sum += wi, squares += wi * wi;
            mx += wi * x[i], my += wi * y[i], mc += wi * cosf(th[i]), ms += wi * sinf(th[i]);
        }
        path[3 * t] = mx / sum, path[3 * t + 1] = my / sum, path[3 * t + 2] = atan2f(ms, mc);
        if (sum * sum / squares < 0.5f * M) {
            double total = 0;
            for (int i = 0; i < M; i++) total += w[i];
            resample(M, w, total, (next(&g) >> 9) * 0x1p-23f, x, y, th, x1, y1, t1);
            float *swap;
            swap = x, x = x1, x1 = swap, swap = y, y = y1, y1 = swap, swap = th, th = t1, t1 = swap;
            for (int i = 0; i < M; i++) lw[i] = 0;
        }
    }
    free(all), free(s);
}
