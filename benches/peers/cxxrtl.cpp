// Runs blocks in a CXXRTL model: `PROGRAM BLOCKS [WAVE]`. A line of BLOCKS holds the load words of one block; for each,
// a line is printed: the clocks until `done`, and the result.
#include "model.cc"

#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "ports.h"
#if defined(WAVE_VCD)
#include <backends/cxxrtl/cxxrtl_vcd.h>

struct Wave {
    cxxrtl::vcd_writer vcd;
    FILE *file = nullptr;

    void open(TOP &top, const char *path) {
        file = std::fopen(path, "wb");
        cxxrtl::debug_items items;
        top.debug_info(items);
        vcd.timescale(100, "ns");
        // The named nets alone, in their scopes.
        for (const char *name : {WAVED}) {
            std::string path = std::string("TOP ") + MODULE + " " + name;
            for (char &c : path)
                if (c == '.') c = ' ';
            vcd.add(path, items.table.at(name).front());
        }
    }
    void dump(uint64_t ticks) {
        vcd.sample(ticks);
        if (vcd.buffer.size() >= 1 << 16) flush();
    }
    void flush() {
        std::fwrite(vcd.buffer.data(), 1, vcd.buffer.size(), file);
        vcd.buffer.clear();
    }
    void close() {
        flush();
        std::fclose(file);
    }
};
#define DUMP(ticks) wave.dump(ticks)
#else
struct Wave {};
#define DUMP(ticks) (void)wave
#endif

static uint64_t run(TOP &top, Wave &wave) {
    top.p_clk.set<bool>(false);
    top.step();
    DUMP(0);
    top.p_clk.set<bool>(true);
    top.step();
#define CLEAR(member) top.member.set<bool>(false);
    STROBES(CLEAR)
    DUMP(10);
    uint64_t clocks = 1;
    do {
        // Both edges: what the next rising edge takes may have been evaluated at the falling one.
        top.p_clk.set<bool>(false);
        top.step();
        // Logic after registers, too, has been evaluated only now.
        if (DONE_IS_LOGIC && top.DONE.get<bool>()) return clocks;
        DUMP(10 * clocks + 5);
        ++clocks;
        top.p_clk.set<bool>(true);
        top.step();
        DUMP(10 * clocks);
    } while (DONE_IS_LOGIC || !top.DONE_REGISTER.get<bool>());
    // Outputs are evaluated before registers are committed.
    top.step();
    return clocks;
}

int main(int argc, char **argv) {
    FILE *blocks = argc > 1 ? std::fopen(argv[1], "r") : nullptr;
    if (!blocks) return 2;
    TOP top;
    Wave wave;
#if defined(WAVE_VCD)
    wave.open(top, argv[2]);
#endif
    for (;;) {
        uint64_t value;
#define LOAD(member)                                              \
    if (std::fscanf(blocks, "%" SCNu64, &value) != 1) break;      \
    top.member.set<uint64_t>(value);
        INPUTS(LOAD)
#define SET(member) top.member.set<bool>(true);
        STROBES(SET)
        std::printf("%" PRIu64, run(top, wave));
#define SHOW(member, width, sign)                                                                 \
    value = top.member.get<uint64_t>();                                                           \
    std::printf(" %" PRId64, sign ? int64_t(value << (64 - width)) >> (64 - width) : int64_t(value));
        RESULT(SHOW)
        std::printf("\n");
    }
#if defined(WAVE_VCD)
    wave.close();
#endif
    return 0;
}
