"""Parts inside parts: submodules in simulation, instances of their own modules in emitted Verilog."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from amaranth.hdl import ClockSignal, Fragment, Instance, Module
from amaranth.lib import wiring


class Part(wiring.Component):
    """A component that becomes its own Verilog module.

    Attributes:
        module_name: name of that module; components of one name must be equal.
        keep_hierarchy: whether a synthesiser must not dissolve the module into its surroundings.
        clocked: whether it has registers, so that its module has a clock.
        clock: the port of its clock.
        latency: cycles from inputs to outputs; 0 of what is combinational.
    """

    module_name: str
    keep_hierarchy = False
    clocked = False
    clock = "clk"
    latency = 0

    @property
    def summary(self) -> str:
        """What it computes, for a comment above its module: the first line of its docstring."""
        return (type(self).__doc__ or "").partition("\n")[0]

    @property
    def port_attributes(self) -> Mapping[str, Mapping[str, str]]:
        """For ports by name the Verilog attributes that tell tools what they are: values by name."""
        return {}


@dataclass
class Emission:
    """The platform while Verilog is written; it collects the parts that a module instantiates.

    Amaranth flattens the ports of submodules into single bits where it can. Writing each part by itself keeps
    its ports as they are declared, and writes a part that occurs nine times once. Without this platform, as
    in Amaranth's simulator, parts are plain submodules and no vendor cell is used.

    Attributes:
        prefix: what the names of all modules begin with, so that two designs can stand in one project.
        parts: the parts found so far, by module name; a part comes after the parts inside it.
    """

    prefix: str = ""
    parts: dict[str, Part] = field(default_factory=dict)

    def module(self, part: Part) -> str:
        """Name of a part's module in the emitted text."""
        return f"{self.prefix}{part.module_name}"

    def instance(self, part: Part) -> Instance:
        """An instance of the part's module, connected to the part's members."""
        name = self.module(part)
        if name not in self.parts:
            # Elaborated here so that its own parts are found, before it.
            Fragment.get(part, self)
            self.parts[name] = part
        ports = {
            f"{'i' if member.flow == wiring.In else 'o'}_{name}": getattr(part, name)
            for name, member in part.signature.members.items()
        }
        if part.clocked:
            ports[f"i_{part.clock}"] = ClockSignal()
        return Instance(name, **ports)


def place(m: Module, name: str, part: Part, platform: object) -> None:
    """Place a part inside a module under construction."""
    m.submodules[name] = platform.instance(part) if isinstance(platform, Emission) else part
