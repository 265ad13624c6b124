#!/usr/bin/env python3
"""Writes the step generator of the package litexcnc as Verilog, through Migen.

usage: stepgen_core.py FILE

Its register bank belongs to LiteX, which is not needed here: the registers are ports of a top module.
"""
import sys
import types


class Anything:
    """In the place of what the bank of registers is made of."""

    def __init__(self, *arguments, **named):
        pass


for name in ["litex", "litex.soc", "litex.soc.interconnect", "litex.soc.interconnect.csr", "litex.soc.integration",
             "litex.soc.integration.soc", "litex.soc.integration.doc", "litex.build", "litex.build.generic_platform"]:
    module = sys.modules[name] = types.ModuleType(name)
    for part in ["SoC", "AutoDoc", "ModuleDoc"]:
        setattr(module, part, type(part, (Anything,), {}))
    module.__all__ = [] if name.endswith(("csr", "generic_platform")) else ["SoC", "AutoDoc", "ModuleDoc"]

from migen import If, Module, Signal
from migen.fhdl import verilog

from litexcnc.firmware.modules.stepgen import StepgenModule


class Top(Module):
    def __init__(self):
        pads = types.SimpleNamespace()
        self.submodules.stepgen = stepgen = StepgenModule(pads, (32, 40, 48), True, lambda *_: None)
        ports = {"speed_in": 47, "acceleration_in": 32, "write": 1, "enable_in": 1, "reset_in": 1}
        self.ports = {name: Signal(bits, name=name) for name, bits in ports.items()}
        # Times in clocks, of which a step shows more than one in a short run.
        self.comb += [stepgen.steplen.eq(3), stepgen.dir_hold_time.eq(2), stepgen.dir_setup_time.eq(4)]
        self.comb += [stepgen.enable.eq(self.ports["enable_in"]), stepgen.reset.eq(self.ports["reset_in"])]
        self.sync += If(
            self.ports["write"],
            stepgen.speed_target.eq(self.ports["speed_in"]),
            stepgen.max_acceleration.eq(self.ports["acceleration_in"]),
        )
        outputs = {"step": stepgen.step, "dir": stepgen.dir, "position": stepgen.position, "speed": stepgen.speed}
        for name, signal in outputs.items():
            self.ports[name] = Signal(len(signal), name=f"{name}_out")
            self.comb += self.ports[name].eq(signal)


top = Top()
with open(sys.argv[1], "w") as file:
    file.write(str(verilog.convert(top, set(top.ports.values()), name="stepgen")))
