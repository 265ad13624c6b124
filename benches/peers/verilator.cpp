// Runs blocks in a Verilator model: `PROGRAM BLOCKS [WAVE]`. A line of BLOCKS holds the load words of one block; for
// each, a line is printed: the clocks until `done`, and the result.
#include "Vmodel.h"
#include "ports.h"

#include <cinttypes>
#include <cstdio>

#include "verilated.h"
#if defined(WAVE_FST)
#include "verilated_fst_c.h"
using Wave = VerilatedFstC;
#elif defined(WAVE_VCD)
#include "verilated_vcd_c.h"
using Wave = VerilatedVcdC;
#else
struct Wave {};
#endif

#if defined(WAVE_FST) || defined(WAVE_VCD)
#define DUMP(ticks) wave.dump(static_cast<uint64_t>(ticks))
#else
#define DUMP(ticks) (void)wave
#endif

static uint64_t run(TOP &top, Wave &wave) {
    top.clk = 0;
    top.eval();
    DUMP(0);
    top.clk = 1;
    top.eval();
#define CLEAR(member) top.member = 0;
    STROBES(CLEAR)
    top.eval();
    DUMP(10);
    uint64_t clocks = 1;
    do {
        top.clk = 0;
        top.eval();
        DUMP(10 * clocks + 5);
        ++clocks;
        top.clk = 1;
        top.eval();
        DUMP(10 * clocks);
    } while (!top.DONE);
    return clocks;
}

int main(int argc, char **argv) {
    FILE *blocks = argc > 1 ? std::fopen(argv[1], "r") : nullptr;
    if (!blocks) return 2;
    VerilatedContext context;
    context.timeunit(-7);
    context.timeprecision(-7);
    Wave wave;
#if defined(WAVE_FST) || defined(WAVE_VCD)
    context.traceEverOn(true);
    TOP top{&context};
    top.trace(&wave, 99);
    wave.open(argv[2]);
#else
    TOP top{&context};
#endif
    for (;;) {
        uint64_t value;
#define LOAD(member)                                              \
    if (std::fscanf(blocks, "%" SCNu64, &value) != 1) break;      \
    top.member = value;
        INPUTS(LOAD)
#define SET(member) top.member = 1;
        STROBES(SET)
        std::printf("%" PRIu64, run(top, wave));
#define SHOW(member, width, sign) \
    std::printf(" %" PRId64, sign ? int64_t(uint64_t(top.member) << (64 - width)) >> (64 - width) : int64_t(top.member));
        RESULT(SHOW)
        std::printf("\n");
    }
    top.final();
#if defined(WAVE_FST) || defined(WAVE_VCD)
    wave.close();
#endif
    return 0;
}
