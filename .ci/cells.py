#!/usr/bin/env python3
"""Every cell that `stepwave import` takes, with random widths and signs, against Yosys' own definitions in Icarus.

usage: cells.py STEPWAVE FOLDER [SEED [DESIGNS [YOSYS SIMLIB]]]

A design is a module of random cells, written as instances of Yosys' cell types. Yosys reads them as the cells
themselves; Icarus takes their definitions from simlib.v. Both run the same random inputs; the settled value of every
output is compared in every clock. A bit that is x in Icarus may be anything.
"""
import pathlib
import random
import re
import subprocess
import sys

CLOCKS = 48
BINARY = "and or xor xnor add sub mul div mod divfloor modfloor lt le eq ne ge gt eqx nex logic_and logic_or".split()
UNARY = "not pos neg reduce_and reduce_or reduce_xor reduce_xnor reduce_bool logic_not".split()
SHIFTS = "shl sshl shr sshr shift shiftx".split()
CHOICES = "mux pmux bmux demux".split()
NEWER = "bweqx bwmux".split()
REGISTERS = "dff dffe adff adffe sdff sdffe sdffce aldff aldffe dffsr dffsre".split()


class Design:
    """A module of random cells, its inputs and its outputs."""

    def __init__(self, rng, kinds):
        self.rng, self.inputs, self.outputs, self.body = rng, [("phase", 2)], [], []
        self.kinds = kinds

    def operand(self, width, wide=64):
        """An expression of new inputs of this width; each is at most 64 bits wide."""
        parts = []
        while width > 0:
            bits = min(width, wide)
            name = f"i{len(self.inputs)}"
            self.inputs.append((name, bits))
            parts.append(name)
            width -= bits
        return "{" + ", ".join(reversed(parts)) + "}" if len(parts) > 1 else parts[0]

    def output(self, width):
        name = f"o{len(self.outputs)}"
        self.outputs.append((name, width))
        return name

    def width(self, most=140):
        return self.rng.choice([1, 2, self.rng.randint(3, 20), self.rng.randint(21, 64), self.rng.randint(1, most), most])

    def instance(self, kind, parameters, pins):
        shown = ", ".join(f".{name}({value})" for name, value in parameters.items())
        wires = ", ".join(f".{name}({value})" for name, value in pins.items())
        self.body.append(f"  \\${kind} #({shown}) c{len(self.body)} ({wires});")

    def cell(self, kind):
        rng = self.rng
        if kind in BINARY or kind in SHIFTS:
            # Icarus divides words of more than 64 bits by 1 to 0.
            most = 140 if kind not in ("div", "mod", "divfloor", "modfloor") else 64
            a, b, y = self.width(most), self.width(most), self.width(most)
            if kind in SHIFTS:
                b = rng.randint(1, 8)
            a_signed = b_signed = rng.randint(0, 1)
            if kind in SHIFTS:
                b_signed = rng.randint(0, 1) if kind in ("shift", "shiftx") else 0
                a_signed = 0 if kind == "shiftx" else rng.randint(0, 1)
            if kind == "logic_and" or kind == "logic_or":
                y = rng.randint(1, 3)
            sizes = dict(A_SIGNED=a_signed, B_SIGNED=b_signed, A_WIDTH=a, B_WIDTH=b, Y_WIDTH=y)
            self.instance(kind, sizes, dict(A=self.operand(a), B=self.operand(b), Y=self.output(y)))
        elif kind in UNARY:
            a, y = self.width(), self.width()
            sizes = dict(A_SIGNED=rng.randint(0, 1), A_WIDTH=a, Y_WIDTH=y)
            self.instance(kind, sizes, dict(A=self.operand(a), Y=self.output(y)))
        elif kind == "mux" or kind == "bwmux":
            w = self.width()
            s = self.operand(1 if kind == "mux" else w)
            self.instance(kind, dict(WIDTH=w), dict(A=self.operand(w), B=self.operand(w), S=s, Y=self.output(w)))
        elif kind == "pmux":
            w, s = self.width(40), rng.randint(1, 5)
            # The select bits are exclusive, as `proc` makes them.
            index = self.operand(3)
            select = "{" + ", ".join(f"{index} == {bit}" for bit in reversed(range(s))) + "}"
            pins = dict(A=self.operand(w), B=self.operand(w * s), S=select, Y=self.output(w))
            self.instance(kind, dict(WIDTH=w, S_WIDTH=s), pins)
        elif kind == "bmux":
            # simlib.v takes single bits of wider words.
            w, s = 1, rng.randint(1, 5)
            pins = dict(A=self.operand(w << s), S=self.operand(s), Y=self.output(w))
            self.instance(kind, dict(WIDTH=w, S_WIDTH=s), pins)
        elif kind in NEWER:
            w = self.width()
            pins = dict(A=self.operand(w), B=self.operand(w), Y=self.output(w))
            self.instance(kind, dict(WIDTH=w), pins | (dict(S=self.operand(w)) if kind == "bwmux" else {}))
        elif kind == "demux":
            w, s = rng.randint(1, 20), rng.randint(1, 4)
            pins = dict(A=self.operand(w), S=self.operand(s), Y=self.output(w << s))
            self.instance(kind, dict(WIDTH=w, S_WIDTH=s), pins)
        else:
            self.register(kind)

    def register(self, kind):
        rng, w = self.rng, self.width(80)
        parameters, pins = dict(WIDTH=w, CLK_POLARITY=1), dict(CLK="clk", D=self.operand(w), Q=self.output(w))
        value = f"{w}'b" + "".join(rng.choice("01") for _ in range(w))

        def control(pin, bits=1):
            polarity = rng.randint(0, 1)
            parameters[f"{pin}_POLARITY"] = polarity
            # Active one time in four, or half of the controls would hide the data.
            both = f"({self.operand(bits)} & {self.operand(bits)})"
            pins[pin] = both if polarity else f"~{both}"

        if kind.endswith("e"):
            control("EN")
        if kind.startswith("adff"):
            control("ARST")
            parameters["ARST_VALUE"] = value
        if kind.startswith("sdff"):
            control("SRST")
            parameters["SRST_VALUE"] = value
        if kind.startswith("aldff"):
            control("ALOAD")
            # In simulation a change of AD while ALOAD is active is not followed; in hardware it is.
            pins["AD"] = value
        if kind.startswith("dffsr"):
            # Never both, nor one right after the other: in simulation the order of the two changes decides.
            for pin, phase in [("SET", 0), ("CLR", 2)]:
                active = f"({self.operand(w)} & {{{w}{{phase == {phase}}}}})"
                polarity = rng.randint(0, 1)
                parameters[f"{pin}_POLARITY"] = polarity
                pins[pin] = active if polarity else f"~{active}"
        self.instance(kind, parameters, pins)

    def verilog(self):
        ports = ["input clk"]
        ports += [f"input [{bits - 1}:0] {name}" for name, bits in self.inputs]
        ports += [f"output [{bits - 1}:0] {name}" for name, bits in self.outputs]
        return "module t(" + ", ".join(ports) + ");\n" + "\n".join(self.body) + "\nendmodule\n"

    def bench(self, rows):
        lines = ["module tb;", "  reg clk = 0;"]
        lines += [f"  reg [{bits - 1}:0] {name} = {value};" for (name, bits), value in zip(self.inputs, rows[0])]
        lines += [f"  wire [{bits - 1}:0] {name};" for name, bits in self.outputs]
        pins = [".clk(clk)"] + [f".{name}({name})" for name, _ in self.inputs + self.outputs]
        lines.append(f"  t dut({', '.join(pins)});")
        shown = ", ".join(name for name, _ in self.outputs)
        form = " ".join("%b" for _ in self.outputs)
        lines.append("  initial begin")
        lines.append(f"    #4 $display(\"{form}\", {shown});")
        for row in rows[1:]:
            sets = " ".join(f"{name} = {value};" for (name, _), value in zip(self.inputs, row))
            lines.append(f"    #1 clk = 1; #1 {sets} #5 $display(\"{form}\", {shown}); #1 clk = 0; #1;")
        lines += ["    $finish;", "  end", "endmodule"]
        return "\n".join(lines) + "\n"


def sampled(path, names, clocks):
    """The values of some signals of a VCD in every clock, in binary; one tick of time is half a clock."""
    codes, depth, values, rows, widths = {}, 0, {}, [], {}
    for line in path.read_text().splitlines():
        word = line.split()
        if not word:
            continue
        depth += {"$scope": 1, "$upscope": -1}.get(word[0], 0)
        if word[0] == "$var" and depth == 1:
            codes.setdefault(word[3], []).append(word[4])
            widths[word[4]] = int(word[2])
        elif word[0].startswith("#"):
            rows.append((int(word[0][1:]), dict(values)))
        elif word[0][0] in "01" and word[0][0] != "#":
            for name in codes.get(word[0][1:], []):
                values[name] = word[0][0]
        elif word[0][0] == "b":
            for name in codes.get(word[1], []):
                values[name] = word[0][1:]
    rows.append((None, dict(values)))
    # The values before the time stamp k+1 are those after k.
    states = {}
    for (time, _), (_, after) in zip(rows, rows[1:]):
        states[time] = after
    period = 10
    result, last = [], {}
    for clock in range(clocks):
        last = states.get(clock * period, last)
        shown = {name: value.rjust(widths[name], "0") for name, value in last.items()}
        result.append({name: whole(shown, name) for name in names})
    return result


def whole(values, name):
    """The value of a word, which has a signal for every 64 bits where it is wider."""
    if name in values:
        return values[name]
    parts = [(int(low), part) for part in values for low in re.findall(rf"^{name}_\d+_(\d+)$", part)]
    return "".join(values[part] for _, part in sorted(parts, reverse=True))


def check(stepwave, folder, seed, index, yosys, simlib):
    rng = random.Random(seed * 1000 + index)
    newer = [kind for kind in NEWER if f"module \\${kind} " in simlib.read_text()]
    kinds = BINARY + UNARY + SHIFTS + CHOICES + REGISTERS + newer
    design = Design(rng, kinds)
    for kind in kinds if index == 0 else rng.choices(kinds, k=40):
        design.cell(kind)
    few = lambda bits: rng.choice([0, 1, (1 << bits) - 1, 1 << (bits - 1), rng.getrandbits(bits), rng.getrandbits(bits)])
    rows = [[clock % 4] + [few(bits) for _, bits in design.inputs[1:]] for clock in range(CLOCKS)]
    (folder / "t.v").write_text(design.verilog())
    valued = [[f"{bits}'d{value}" for (_, bits), value in zip(design.inputs, row)] for row in rows]
    (folder / "tb.v").write_text(design.bench(valued))
    csv = [",".join(name for name, _ in design.inputs)] + [",".join(map(str, row)) for row in rows]
    (folder / "in.csv").write_text("\n".join(csv) + "\n")
    run = lambda *words: subprocess.run(words, cwd=folder, check=True, capture_output=True, text=True).stdout
    run(yosys, "-q", "-p", f"read_verilog -icells -sv t.v; hierarchy -check -top t; {PASSES}; write_json t.json")
    run(stepwave, "import", "--json", "t.json", "-o", "t.net")
    run("iverilog", "-g2005", "-DSIMLIB_NOCHECKS", "-o", "t.vvp", "tb.v", "t.v", str(simlib))
    lines = [line.split() for line in run("vvp", "-n", "t.vvp").splitlines() if re.fullmatch("[01xz ]+", line)]
    names = [name for name, _ in design.outputs]
    wrong = 0
    for engine in ["gates", "word", "compiled"]:
        run(stepwave, "sim", "t.net", "--stimulus", "in.csv", "--clocks", str(CLOCKS - 1), "--vcd", "t.vcd", "--engine", engine)
        own = sampled(folder / "t.vcd", names, CLOCKS)
        for clock, (mine, theirs) in enumerate(zip(own, lines, strict=True)):
            for name, value in zip(names, theirs):
                assert len(mine[name]) == len(value), (name, mine[name], value)
                if any(b != "x" and a != b for a, b in zip(mine[name], value, strict=True)):
                    line = next(line for line in design.body if f"({name})" in line)
                    print(f"{engine}, clock {clock}: {line.strip()}\n  stepwave {mine[name]}\n  Icarus   {value}")
                    wrong += 1
                    if wrong > 5:
                        return wrong
    return wrong


PASSES = "proc -noopt -norom; flatten; opt_clean; memory_collect; opt_clean"
SIMLIB = [pathlib.Path(path) for path in ("/usr/share/yosys/simlib.v", "/usr/local/share/yosys/simlib.v")]


def main():
    stepwave, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    designs = int(sys.argv[4]) if len(sys.argv) > 4 else 10
    yosys = sys.argv[5] if len(sys.argv) > 5 else "yosys"
    simlib = pathlib.Path(sys.argv[6]) if len(sys.argv) > 6 else next(path for path in SIMLIB if path.exists())
    folder.mkdir(parents=True, exist_ok=True)
    for index in range(designs):
        if check(str(stepwave), folder, seed, index, yosys, simlib):
            sys.exit(f"cells differ from Icarus: seed {seed}, design {index}, files in {folder}")
    print(f"{designs} designs of random cells by {yosys}: every output as in Icarus, on three engines")


main()
