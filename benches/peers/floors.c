/* Lower bounds of time on this machine, on all its cores: reading a file, writing fresh pages, comparing pressures, counting pairs of
 * bits, multiplying and adding. Each line has a name and its seconds.
 *
 * cc -O3 -march=native -mprefer-vector-width=512 -ffp-contract=fast -fopenmp floors.c -o floors && ./floors FILE
 */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define SENSORS 840L
#define SAMPLES 100000L
#define PAIRS (SENSORS * (SENSORS - 1) / 2)

/* Bits that are counted at once, and the sum of a count and those that two of them have in common. */
#ifdef __AVX512VPOPCNTDQ__
#include <immintrin.h>
typedef __m512i Bits;
#define ADD_COMMON(sum, a, b) _mm512_add_epi64(sum, _mm512_popcnt_epi64(_mm512_and_si512(a, b)))
#else
typedef uint64_t Bits;
#define ADD_COMMON(sum, a, b) ((sum) + __builtin_popcountll((a) & (b)))
#endif

#define WORDS ((SAMPLES + 511) / 512 * 512 / 8 / (long)sizeof(Bits)) /* in a plane: a level of a sensor, at all samples */
#define TILE 4                            /* planes of each side that are counted against each other at once */
#define BLOCK (256L << 10)
#define LANES 64 /* sums beside each other, so that none waits for its own last addition */

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec + time.tv_nsec / 1e9;
}

/* A file from the system's memory into blocks of ours. */
static double read_file(const char *name) {
    int file = open(name, O_RDONLY);
    long bytes = file < 0 ? -1 : lseek(file, 0, SEEK_END);
    if (bytes < 0) {
        perror(name);
        exit(2);
    }
    double start = now();
#pragma omp parallel
    {
        char *block = malloc(BLOCK);
#pragma omp for
        for (long at = 0; at < bytes; at += BLOCK) {
            if (pread(file, block, BLOCK, at) < 0) {
                abort();
            }
        }
        free(block);
    }
    double seconds = now() - start;
    close(file);
    return seconds;
}

/* Pressures of float32, into pages that the system has yet to clear. */
static double write_pages(void) {
    long bytes = SENSORS * SAMPLES * sizeof(float);
    double start = now();
    char *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
#pragma omp parallel for
    for (long at = 0; at < bytes; at += BLOCK) {
        memset(memory + at, 1, at + BLOCK < bytes ? BLOCK : bytes - at);
    }
    double seconds = now() - start;
    munmap(memory, bytes);
    return seconds;
}

/* Each pressure compared once, and a byte written for it: a quantiser that knows its limits. */
static double compare(void) {
    long values = SENSORS * SAMPLES;
    float *pressures = malloc(values * sizeof(float));
    unsigned char *levels = malloc(values);
    memset(pressures, 1, values * sizeof(float));
    memset(levels, 1, values);
    double start = now();
#pragma omp parallel for
    for (long at = 0; at < values; at++) {
        levels[at] = pressures[at] > 1e-30f;
    }
    double seconds = now() - start;
    free(pressures);
    free(levels);
    return seconds;
}

/* Of each pair of sensors, how often each two levels above 0 are felt together: and, count, add. A tile of planes is in the first cache,
 * and each word of it is loaded once for all pairs of the tile. */
static double count(long levels) {
    Bits *planes = aligned_alloc(64, 2 * TILE * WORDS * sizeof(Bits));
    memset(planes, 0x5a, 2 * TILE * WORDS * sizeof(Bits));
    long tiles = PAIRS * (levels - 1) * (levels - 1) / (TILE * TILE);
    double start = now();
#pragma omp parallel for
    for (long tile = 0; tile < tiles; tile++) {
        Bits pairs[TILE][TILE];
        memset(pairs, 0, sizeof(pairs));
        for (long word = 0; word < WORDS; word++) {
#pragma GCC unroll 4
            for (int a = 0; a < TILE; a++) {
#pragma GCC unroll 4
                for (int b = 0; b < TILE; b++) {
                    pairs[a][b] = ADD_COMMON(pairs[a][b], planes[a * WORDS + word], planes[(TILE + b) * WORDS + word]);
                }
            }
        }
        __asm__ volatile("" : : "r"(pairs) : "memory"); /* the compiler may not reuse the counts of the tile before */
    }
    double seconds = now() - start;
    free(planes);
    return seconds;
}

/* A billion multiplications and additions of float64 on each core. */
static double multiply_add(void) {
    double start = now();
#pragma omp parallel
    {
        double sums[LANES], factor = 0.999, addend = 0.001;
        for (int lane = 0; lane < LANES; lane++) {
            sums[lane] = lane;
        }
        __asm__ volatile("" : "+x"(factor), "+x"(addend));
        for (long round = 0; round < 1000000000L / LANES; round++) {
            for (int lane = 0; lane < LANES; lane++) {
                sums[lane] = sums[lane] * factor + addend;
            }
        }
        __asm__ volatile("" : : "r"(sums) : "memory");
    }
    return now() - start;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: floors FILE\n");
        return 2;
    }
    printf("read %.4f\n", read_file(argv[1]));
    printf("pages %.4f\n", write_pages());
    printf("compare %.4f\n", compare());
    printf("count-4 %.4f\n", count(4));
    printf("count-8 %.4f\n", count(8));
    printf("multiply-add %.4f\n", multiply_add());
    return 0;
}
