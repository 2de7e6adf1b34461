/* The least that this machine needs for what the stages cannot do without, measured on all its cores: reading a file, writing fresh
 * pages, reading memory, counting pairs of bits, multiplying and adding. Prints a name and its seconds in each line.
 *
 * cc -O3 -march=native -ffast-math -fopenmp floors.c -o floors && ./floors FILE
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
#define WORDS ((SAMPLES + 63) / 64) /* of 64 bits, in a plane: a level of a sensor, at all samples */
#define BLOCK (8L << 20)
#define LANES 128 /* sums beside each other, so that none waits for its own last addition */

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec + time.tv_nsec / 1e9;
}

/* A file from the system's memory into a block of ours. */
static double read_file(const char *name) {
    char *block = malloc(BLOCK);
    memset(block, 1, BLOCK);
    double start = now();
    int file = open(name, O_RDONLY);
    while (read(file, block, BLOCK) > 0) {
    }
    close(file);
    double seconds = now() - start;
    free(block);
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

/* Of each pair of sensors, how often each two levels above 0 are felt together: and, count, add, from two planes in the first cache. */
static double count(long levels) {
    uint64_t *planes = malloc(2 * WORDS * sizeof(uint64_t));
    memset(planes, 0x5a, 2 * WORDS * sizeof(uint64_t));
    long products = PAIRS * (levels - 1) * (levels - 1), sum = 0;
    double start = now();
#pragma omp parallel for reduction(+ : sum)
    for (long product = 0; product < products; product++) {
        long pairs = 0;
        for (long word = 0; word < WORDS; word++) {
            pairs += __builtin_popcountll(planes[word] & planes[WORDS + word]);
        }
        __asm__ volatile("" : "+r"(pairs) : : "memory"); /* the compiler may not keep it from the last product */
        sum += pairs;
    }
    double seconds = now() - start;
    free(planes);
    return sum ? seconds : 0;
}

/* A billion multiplications and additions of float64 on each core. */
static double multiply_add(void) {
    double start = now();
#pragma omp parallel
    {
        double sums[LANES] = {0}, factor = 0.999;
        __asm__ volatile("" : "+x"(factor));
        for (long round = 0; round < 1000000000L / LANES; round++) {
            for (int lane = 0; lane < LANES; lane++) {
                sums[lane] = sums[lane] * factor + factor;
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
