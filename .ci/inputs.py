#!/usr/bin/env python3
"""The inputs of a run out of its VCD, as the stimulus of a netlist; prints the clocks.

usage: inputs.py RUN.vcd DESIGN.net OUT.csv
"""
import re
import sys

wave, netlist, out = sys.argv[1:]
text = open(netlist).read()
inputs = set(re.findall(r"^(%\d+):\d+ = input", text, flags=re.M))
wanted = [name for net, name in re.findall(r'^name (%\d+) in 0 "(\w+)"', text, flags=re.M) if net in inputs]

codes, scope, values, rows, period = {}, [], {}, {}, 10
lines = open(wave).read().splitlines()
for line in lines:
    word = line.split()
    if not word:
        continue
    if word[0] == "$scope":
        scope.append(word[2])
    elif word[0] == "$upscope":
        scope.pop()
    elif word[0] == "$var":
        # Verilog names a port of a scope with the scope in front.
        codes.setdefault(word[3], []).append("_".join(scope[1:] + [word[4]]))
    elif word[0][0] == "#":
        now = int(word[0][1:])
        rows[now // period] = values
    elif word[0][0] in "01":
        values = values | {name: int(word[0][0]) for name in codes.get(word[0][1:], [])}
        rows[now // period] = values
    elif word[0][0] == "b" and len(word) == 2:
        values = values | {name: int(word[0][1:], 2) for name in codes.get(word[1], [])}
        rows[now // period] = values
clocks = max(rows)
with open(out, "w") as file:
    print(",".join(wanted), file=file)
    last = {}
    for clock in range(clocks + 1):
        last = rows.get(clock, last)
        print(",".join(str(last.get(name, 0)) for name in wanted), file=file)
print(clocks)
