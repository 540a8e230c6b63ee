#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`power_intent.py FILE TOP [PARAMETER=VALUE]...`: checks constraints/power_intent/*.upf against the RTL.

A problem is a name that does not exist, an instance in no domain or in two, an output that leaves a domain that is off without a clamp or
with another value than between frames, a supply without a source, a state of an unknown supply, or a memory of the prior that would lose
its words. Exits non-zero if there is one."""

import re
import sys
from pathlib import Path

from dtof_synth import program
from upf import OPTIONS, Command, Design, IntentError, Scope, elaborate, execute, inside

PRIOR_HOLDERS = ("dtof_pool_quad", "dtof_pool_parity_store")  # the modules whose memories hold groups' words and their parities
PRIOR_FLAG = "u_control.g_prior.ended_q"  # of dtof_pool_pointer_array
# These have no meaning while valid or an enable is low, so their clamp is free.
QUALIFIED = {"result_tdata_o", "result_tlast_o", "read_addr_i", "write_addr_i", "write_parts_i", "write_data_i"}


class Checker:
    """Problems of an intent. Objects have the path of their scope in front of their name."""

    def __init__(self, commands: list[Command], design: Design) -> None:
        self.design = design
        self.found: list[str] = []
        self.by_name: dict[str, list[Command]] = {name: [] for name in OPTIONS}
        for entry in commands:
            self.by_name[entry.name].append(entry)
        self.declared = {kind: self.names(kind) for kind in (
            "create_supply_port", "create_supply_net", "create_supply_set", "create_logic_port", "create_logic_net", "create_power_domain")}  # fmt: skip
        self.states: dict[str, dict[str, dict[str, str]]] = {}  # of a supply set or a domain: state, what it says of which supply

    def say(self, text: str) -> None:
        self.found.append(text)

    def names(self, kind: str) -> dict[str, Command]:
        declared: dict[str, Command] = {}
        for entry in self.by_name[kind]:
            path = entry.path(entry.positional[0])
            if path in declared:
                self.say(f"{path}: declared twice")
            declared[path] = entry
        return declared

    def needs(self, entry: Command, kind: str, name: str) -> str:
        path = entry.path(name)
        if path not in self.declared[kind]:
            self.say(f"{entry.name} {entry.positional[0]}: {kind.removeprefix('create_')} {path} is not declared")
        return path

    def run(self) -> list[str]:
        self.check_supplies()
        self.check_logic()
        self.check_states()
        self.check_domains()
        self.check_isolation()
        self.check_retention()
        return self.found

    def check_supplies(self) -> None:
        sources: dict[str, list[str]] = {net: [] for net in self.declared["create_supply_net"]}
        for entry in self.by_name["connect_supply_net"]:
            net = self.needs(entry, "create_supply_net", entry.positional[0])
            for name in entry.one("-ports"):
                port = self.needs(entry, "create_supply_port", name)
                if "/" not in name:
                    sources.setdefault(net, []).append(port)
        for switch in self.by_name["create_power_switch"]:
            self.needs(switch, "create_power_domain", switch.one("-domain")[0])
            inner, net = switch.one("-input_supply_port")
            self.needs(switch, "create_supply_net", net)
            sources.setdefault(self.needs(switch, "create_supply_net", switch.one("-output_supply_port")[1]), []).append(f"switch {switch.positional[0]}")
            control, signal = switch.one("-control_port")
            self.needs(switch, "create_logic_port", signal)
            for option, expression in (("-on_state", switch.one("-on_state")[2:]), ("-off_state", switch.one("-off_state")[1:])):
                if expression != [control if option == "-on_state" else f"!{control}"]:
                    self.say(f"switch {switch.positional[0]}: {option} does not follow {control}")
            if switch.one("-on_state")[1] != inner:
                self.say(f"switch {switch.positional[0]}: {switch.one('-on_state')[1]} is no input")
        for net, drivers in sources.items():
            if len(drivers) != 1:
                self.say(f"supply net {net} has {len(drivers)} sources")
        fed = {entry.path(name) for entry in self.by_name["connect_supply_net"] for name in entry.one("-ports") if "/" in name}
        for port, entry in self.declared["create_supply_port"].items():
            if entry.scope and port not in fed:
                self.say(f"supply port {port} is not connected")
        for entry in self.by_name["create_supply_set"]:
            functions = dict(entry.options["-function"])
            if set(functions) != {"power", "ground"}:
                self.say(f"supply set {entry.positional[0]} needs power and ground")
            for net in functions.values():
                self.needs(entry, "create_supply_net", net)

    def check_logic(self) -> None:
        joined = set()
        for entry in self.by_name["connect_logic_net"]:
            self.needs(entry, "create_logic_net", entry.positional[0])
            ports = [self.needs(entry, "create_logic_port", name) for name in entry.one("-ports")]
            if len(ports) == 2 and ports[0] == entry.path(ports[1].rsplit(".", 1)[-1]):
                joined.add(ports[1])
        for port, entry in self.declared["create_logic_port"].items():
            if port.rsplit(".", 1)[-1] in self.design.scopes[entry.scope].ports:
                self.say(f"logic port {port} is a port of the RTL")
            if entry.scope and port not in joined:
                self.say(f"logic port {port} is not connected")

    def switched(self, supply: str) -> bool:
        """Whether a switch feeds the supply set."""
        entry = self.declared["create_supply_set"].get(supply)
        nets = {switch.path(switch.one("-output_supply_port")[1]) for switch in self.by_name["create_power_switch"]}
        return entry is not None and any(entry.path(net) in nets for _, net in entry.options["-function"])

    def check_states(self) -> None:
        for entry in self.by_name["add_power_state"]:
            path = entry.path(entry.positional[0])
            is_set = path in self.declared["create_supply_set"]
            if not is_set:
                self.needs(entry, "create_power_domain", entry.positional[0])
            states = self.states.setdefault(path, {})
            for state, *rest in entry.options["-state"]:
                values = dict(zip(rest[::2], rest[1::2], strict=True))
                states[state] = {}
                expression = values.pop("-supply_expr" if is_set else "-logic_expr", "")
                pairs = [re.fullmatch(r"(\w+) == (\w+)", part) for part in expression.split(" && ")]
                if set(values) - {"-simstate"} or not all(pairs):
                    self.say(f"{path}: state {state} is not understood")
                states[state] = {pair[1]: pair[2] for pair in pairs if pair}
                if is_set and (set(states[state]) - {"power", "ground"} or set(states[state].values()) - {"FULL_ON", "OFF"}):
                    self.say(f"{path}: state {state} is not understood")
                if not is_set:
                    for name in states[state]:
                        self.needs(entry, "create_supply_set", name)
        for path in self.declared["create_supply_set"]:
            wanted = {"on", "off"} if self.switched(path) else {"on"}
            if set(self.states.get(path, {})) != wanted:
                self.say(f"supply set {path}: states {' and '.join(sorted(wanted))} expected")
        for path, entry in self.declared["create_power_domain"].items():
            for state, supplies in self.states.get(path, {}).items():
                for name, value in supplies.items():
                    if value not in self.states.get(entry.path(name), {}):
                        self.say(f"{path}: state {state}: supply {name} has no state {value}")

    def isolation_of(self, root: str, port: str) -> list[Command]:
        """The strategies for a port on the border of a domain; one that names the port comes before one for all."""
        path, domain = inside(root, port), self.roots[root]
        direction = "outputs" if self.design.scopes[root].ports[port] == "OUTPUT" else "inputs"
        candidates = [entry for entry in self.by_name["set_isolation"] if entry.path(entry.one("-domain")[0]) == domain]
        chosen = [entry for entry in candidates if path in [entry.path(name) for name in entry.one("-elements") if name]]
        return chosen or [entry for entry in candidates if "-elements" not in entry.options and entry.one("-applies_to") == [direction]]

    def supply_of(self, domain: str) -> str:
        entry = self.declared["create_power_domain"][domain]
        handle, name = entry.one("-supply") if len(entry.one("-supply")) == 2 else ("", "")
        if handle != "primary":
            self.say(f"domain {domain} has no primary supply")
            return ""
        return self.needs(entry, "create_supply_set", name)

    def is_on(self, supply: str, state: dict[str, str], scope: str) -> bool:
        return not self.switched(supply) or any(inside(scope, name) == supply and value == "on" for name, value in state.items())

    def check_domains(self) -> None:
        self.roots: dict[str, str] = {}  # domain of an instance that a domain names
        self.supplies = {domain: self.supply_of(domain) for domain in self.declared["create_power_domain"]}
        for domain, entry in self.declared["create_power_domain"].items():
            for name in entry.one("-elements"):
                path = entry.path(name)
                if path not in self.design.scopes or not self.design.scopes[path].module:
                    self.say(f"domain {domain}: no instance {path}")
                elif path in self.roots:
                    self.say(f"instance {path or self.design.top} is in {self.roots[path]} and in {domain}")
                else:
                    self.roots[path] = domain
            if domain not in self.roots.values():
                self.say(f"domain {domain} has no instance")
        for path in self.design.instances():
            if not self.domain_of(path):
                self.say(f"instance {path or self.design.top} is in no domain")

    def root_of(self, path: str) -> str | None:
        while path not in self.roots:
            if not path:
                return None
            path = path.rpartition(".")[0]
        return path

    def domain_of(self, path: str) -> str:
        root = self.root_of(path)
        return "" if root is None else self.roots[root]

    def all_states(self) -> list[tuple[str, dict[str, str]]]:
        """(scope, supplies) of each state of a domain."""
        return [(entry.scope, state) for domain, entry in self.declared["create_power_domain"].items()
                for state in self.states.get(domain, {}).values()]  # fmt: skip

    def may_differ(self, source: str, sink: str) -> bool:
        """Whether a state has the source's supply off and the sink's on. An empty sink is outside of the top, and always on."""
        return self.switched(source) and any(
            not self.is_on(source, state, scope) and (not sink or self.is_on(sink, state, scope)) for scope, state in self.all_states())

    def check_isolation(self) -> None:
        owners: dict[str, list[str]] = {}
        for entry in self.by_name["set_isolation"]:
            domain = self.needs(entry, "create_power_domain", entry.one("-domain")[0])
            signal = entry.one("-isolation_signal")
            self.needs(entry, "create_logic_port", signal[0] if signal else "")
            if entry.one("-isolation_sense") != ["high"] or entry.one("-location") != ["self"]:
                self.say(f"isolation {entry.positional[0]}: sense high and location self expected")
            for name in entry.one("-elements"):
                path = entry.path(name)
                owner, _, port = path.rpartition(".")
                if not name or port not in self.design.scopes.get(owner, Scope()).ports:
                    if "-elements" in entry.options:
                        self.say(f"isolation {entry.positional[0]}: no port {path}")
                elif self.roots.get(owner) != domain:
                    self.say(f"isolation {entry.positional[0]}: port {path} is not on the border of {domain}")
                owners.setdefault(path, []).append(entry.positional[0])
        for path, strategies in owners.items():
            if len(strategies) > 1:
                self.say(f"port {path}: strategies {' and '.join(strategies)}")
        for root, domain in self.roots.items():
            outer = self.domain_of(root.rpartition(".")[0]) if root else ""
            outer_supply = self.supplies.get(outer, "")
            for port, direction in self.design.scopes[root].ports.items():
                if direction == "OUTPUT":
                    self.check_port(root, port, self.supplies[domain], outer_supply)
                elif outer and not self.comes_from_outside(root, port, outer):
                    self.check_port(root, port, outer_supply, self.supplies[domain])

    def comes_from_outside(self, root: str, port: str, outer: str) -> bool:
        """Whether an input of an inner domain is wired to an input of the domain around it."""
        border = self.root_of(root.rpartition(".")[0])
        assert border is not None
        scope = self.design.scopes[border]
        source = self.design.scopes[root].sources.get(port)
        return any(direction == "INPUT" and scope.sources.get(name) == source for name, direction in scope.ports.items())

    def check_port(self, root: str, port: str, source: str, sink: str) -> None:
        path = inside(root, port)
        if not self.may_differ(source, sink):
            return
        chosen = self.isolation_of(root, port)
        if len(chosen) != 1:
            self.say(f"port {path}: {len(chosen)} isolations where one is needed")
            return
        entry = chosen[0]
        supply = self.needs(entry, "create_supply_set", (entry.one("-isolation_supply_set") or [""])[0])
        if self.may_differ(supply, sink):
            self.say(f"port {path}: the supply of its isolation is off where the sink is on")
        clamp, idle = entry.one("-clamp_value"), self.design.idle.get(path, "x")
        if len(clamp) != 1 or clamp[0] not in ("0", "1"):
            self.say(f"port {path}: no clamp value")
        elif port not in QUALIFIED and set(idle) != {clamp[0]}:
            self.say(f"port {path}: clamp {clamp[0]}, but {idle} between frames")

    def check_retention(self) -> None:
        retained = set()
        for entry in self.by_name["set_retention"]:
            domain = self.needs(entry, "create_power_domain", entry.one("-domain")[0])
            for name in entry.one("-elements"):
                path = entry.path(name)
                owner, _, register = path.rpartition(".")
                if register not in self.design.scopes.get(owner, Scope()).registers or self.domain_of(owner) != domain:
                    self.say(f"retention {entry.positional[0]}: no register {path} in {domain}")
                retained.add(path)
            supply = self.needs(entry, "create_supply_set", (entry.one("-retention_supply_set") or [""])[0])
            if self.switched(supply):
                self.say(f"retention {entry.positional[0]}: its supply may be off")
            for option in ("-save_signal", "-restore_signal"):
                signal, *edge = entry.one(option)
                self.needs(entry, "create_logic_port", signal)
                if edge != ["posedge"]:
                    self.say(f"retention {entry.positional[0]}: {option} needs an edge")
        keepers = [(entry, state) for domain, entry in self.declared["create_power_domain"].items()
                   for name, state in self.states.get(domain, {}).items() if name == "idle_with_prior"]  # fmt: skip
        if keepers:
            self.check_prior(keepers[0][0].scope, keepers[0][1], retained)
        elif retained or len([domain for domain in self.supplies if self.switched(self.supplies[domain])]) > 1:
            self.say("something is kept, but no state idle_with_prior")

    def check_prior(self, scope: str, state: dict[str, str], retained: set[str]) -> None:
        """Between frames with a prior, the quads' memories and the flag are kept, and nothing else."""
        for path, instance in self.design.scopes.items():
            if instance.module == "dtof_sram" and path.startswith(f"{scope}.".lstrip(".")):
                holder = self.design.scopes[path.rsplit(".", 1)[0]].module
                kept = self.is_on(self.supplies.get(self.domain_of(path), ""), state, scope)
                if kept != (holder in PRIOR_HOLDERS):
                    self.say(f"memory {path} is {'kept' if kept else 'not kept'} in idle_with_prior")
        if retained != {inside(scope, PRIOR_FLAG)}:
            self.say(f"retention: {inside(scope, PRIOR_FLAG)} and no other register must be kept")


def problems(file: Path, design: Design, settings: dict[str, str], separator: str = ".") -> list[str]:
    try:
        return Checker(execute(file, design, settings, separator), design).run()
    except IntentError as error:
        return [str(error)]


def main() -> int:
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    file, top, *parameters = sys.argv[1:]
    if not Path(file).is_file():
        print(f"error: {file} is no file", file=sys.stderr)
        return 2
    values: dict[str, int] = {}
    for parameter in parameters:
        if not (match := re.fullmatch(r"(\w+)=(\d+)", parameter)):
            print(f"error: '{parameter}' is not PARAMETER=VALUE", file=sys.stderr)
            return 2
        values[match[1]] = int(match[2])
    try:
        design = elaborate(top, values)
    except IntentError as error:
        print(f"error: {top} with these parameters: {str(error).splitlines()[0].removeprefix('error: ')}", file=sys.stderr)
        return 2
    found = problems(Path(file), design, {"dtof_prior": str(values.get("PRIOR", 0))})
    for problem in found:
        print(f"error: {file}: {problem}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
