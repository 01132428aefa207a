#!/usr/bin/env python3
"""Compares `belvedere-dis decode` with tshark on captures: every field that both print, of the first PDU of each datagram.

usage: compare_with_tshark.py BELVEDERE_DIS CAPTURE_OR_FOLDER...

tshark 4.0 dissects only the first PDU of a bundle, prints floats to 6 digits and doubles to 15. Exits 0 when all agree,
1 when something differs, 77 when there is no tshark or no capture.
"""
import collections
import json
import pathlib
import shutil
import subprocess
import sys

FLOAT, DOUBLE, MICROSECOND = 1e-5, 2e-14, 2e-6


class Comparison:
    def __init__(self):
        self.counts = collections.Counter()
        self.mismatches = []

    def exact(self, where, field, ours, theirs):
        self.counts[field] += 1
        if ours != theirs:
            self.mismatches.append(f"{where}: {field}: belvedere {ours!r}, tshark {theirs!r}")

    def near(self, where, field, ours, theirs, relative, absolute=0.0):
        self.counts[field] += 1
        if not abs(ours - theirs) <= relative * max(abs(ours), abs(theirs)) + absolute:
            self.mismatches.append(f"{where}: {field}: belvedere {ours!r}, tshark {theirs!r}")


def lists(pairs):
    """JSON objects with repeated keys, as dicts of lists."""
    result = collections.defaultdict(list)
    for key, value in pairs:
        result[key].append(value)
    return result


def child(node, prefix, index=0):
    """The index-th child whose name starts so; None where there is none."""
    found = [value for key, values in node.items() if key.startswith(prefix) for value in values]
    found = [value for group in found for value in (group if isinstance(group, list) else [group])]
    return found[index] if index < len(found) else None


def number(text):
    return int(text, 16) if text.lower().startswith("0x") else int(text)


def entity_id(node):
    names = ("dis.entity_id_site", "dis.entity_id_application", "dis.entity_id_entity")
    if "dis.event_number" in node:
        names = ("dis.site", "dis.application", "dis.event_number")
    return ":".join(node[name][0] for name in names)


def entity_type(node):
    category = next(value[0] for key, value in node.items() if key.startswith("dis.category"))
    names = ("dis.subcategory", "dis.specific", "dis.extra")
    head = [node[name][0] for name in ("dis.entityKind", "dis.entityDomain", "dis.country")]
    return ".".join(head + [category] + [node[name][0] for name in names])


class Body:
    """One PDU of ours beside tshark's tree of it."""

    def __init__(self, comparison, where, ours, tree):
        self.comparison, self.where, self.ours, self.tree = comparison, where, ours, tree

    def integer(self, field, name, node=None):
        node = self.tree if node is None else node
        if name in node and field in self.ours:
            self.comparison.exact(self.where, field, self.ours[field], number(node[name][0]))

    def id(self, field, prefix):
        node = child(self.tree, prefix)
        if node is not None:
            self.comparison.exact(self.where, field, self.ours[field], entity_id(node))

    def type(self, field, prefix):
        node = child(self.tree, prefix)
        if node is not None:
            self.comparison.exact(self.where, field, self.ours[field], entity_type(node))

    def triple(self, field, node, names, relative):
        if node is None:
            return
        for i, name in enumerate(names):
            self.comparison.near(self.where, f"{field}[{i}]", self.ours[field][i], float(node[name][0]), relative, 1e-12)

    def vector(self, field, prefix, name, relative, tree=None):
        node = child(self.tree if tree is None else tree, prefix)
        self.triple(field, node, [f"{name}.{axis}" for axis in "xyz"], relative)

    def descriptor(self):
        node = child(self.tree, "Burst Descriptor")
        if node is None:
            return
        ours = self.ours["descriptor"]
        self.comparison.exact(self.where, "descriptor.type", ours["type"], entity_type(child(node, "Munition,")))
        names = {"warhead": "dis.warhead", "fuse": "dis.fuse", "quantity": "dis.quality", "rate": "dis.rate"}
        for field, name in names.items():
            self.comparison.exact(self.where, f"descriptor.{field}", ours[field], number(node[name][0]))

    def parts(self):
        if "dis.num_articulation_params" not in self.tree:
            return
        count = number(self.tree["dis.num_articulation_params"][0])
        self.comparison.exact(self.where, "parts", len(self.ours["parts"]), count)
        for i, part in enumerate(self.ours["parts"]):
            node = child(self.tree, "Variable Parameter", i)
            if node is None:
                break
            pairs = {"record_type": "dis.variable_parameter_type", "change": "dis.vp.change",
                     "attached_to": "dis.vp.part_attached_to_id", "part_type": "dis.vp.artic_param_type"}
            for field, name in pairs.items():
                if field in part and name in node:
                    self.comparison.exact(self.where, f"parts.{field}", part[field], number(node[name][0]))
            if "value" in part and "dis.vp.parameter_value" in node:
                theirs = float(node["dis.vp.parameter_value"][0])
                self.comparison.near(self.where, "parts.value", part["value"], theirs, FLOAT)


def compare_entity_state(body):
    body.id("entity", "Entity ID")
    body.integer("force", "dis.force_id")
    body.type("entity_type", "Entity Type,")
    body.type("alternative_type", "Alternative Entity Type,")
    body.vector("velocity_mps", "Entity Linear Velocity", "dis.entity_linear_velocity", FLOAT)
    body.vector("position_m", "Entity Location", "dis.entity_location", DOUBLE)
    angles = [f"dis.entity_orientation.{angle}" for angle in ("psi", "theta", "phi")]
    body.triple("orientation_rad", child(body.tree, "Entity Orientation"), angles, FLOAT)
    body.integer("appearance", "dis.appearance")
    body.integer("capabilities", "dis.capabilities")
    motion = child(body.tree, "Dead Reckoning Parameters")
    if motion is not None:
        body.integer("drm", "dis.entity_marking_character_set", motion)  # so named in tshark's own table
        body.vector("acceleration_mps2", "Entity Linear Acceleration", "dis.entity_linear_acceleration", FLOAT, motion)
        body.vector("angular_velocity_radps", "Entity Angular Velocity", "dis.entity_angular_velocity", FLOAT, motion)
    marking = child(body.tree, "Entity Marking")
    if marking is not None:
        body.integer("character_set", "dis.entity_marking_character_set", marking)
        # Nothing is printed for a character set that tshark does not know.
        printed = marking.get("dis.entity_marking")
        if printed is None:
            return body.parts()
        theirs = "".join(c if " " <= c <= "~" else "?" for c in printed[0]).rstrip(" ")
        body.comparison.exact(body.where, "marking", body.ours["marking"], theirs)
    body.parts()


def compare_fire(body):
    for field, prefix in (("firing", "Firing"), ("target", "Target"), ("munition", "Munition ID"), ("event", "Event")):
        body.id(field, prefix)
    body.integer("fire_mission", "dis.fire.mission_index")
    body.vector("position_m", "Location in World", "dis.fire.location", DOUBLE)
    body.descriptor()
    body.vector("velocity_mps", "Velocity", "dis.linear_velocity", FLOAT)
    body.comparison.near(body.where, "range_m", body.ours["range_m"], float(body.tree["dis.range"][0]), FLOAT)


def compare_detonation(body):
    for field, prefix in (("firing", "Firing"), ("target", "Target"), ("munition", "Munition ID"), ("event", "Event")):
        body.id(field, prefix)
    body.vector("velocity_mps", "Velocity", "dis.linear_velocity", FLOAT)
    body.vector("position_m", "Location in World", "dis.detonation.location", DOUBLE)
    body.descriptor()
    body.vector("position_in_target_m", "Location in Entity", "dis.entity_location", FLOAT)
    body.integer("result", "dis.detonation.result")
    body.parts()


BODIES = {1: ("Entity State PDU", compare_entity_state), 2: ("Fire PDU", compare_fire),
          3: ("Detonation PDU", compare_detonation)}


def compare_pdu(comparison, where, ours, theirs):
    header = child(theirs, "Header")
    names = {"version": "dis.proto_ver", "exercise": "dis.exer_id", "type": "dis.pdu_type", "family": "dis.proto_fam",
             "length": "dis.pdu_length", "status": "dis.pdu_status"}
    for field, name in names.items():
        if field in ours and name in header:
            comparison.exact(where, field, ours[field], number(header[name][0]))
    seconds = float(header["dis.timestamp"][0])
    comparison.near(where, "timestamp", ours["timestamp_s"], seconds, 0.0, MICROSECOND)
    if ours["type"] in BODIES and "ignored" not in ours:
        prefix, compare = BODIES[ours["type"]]
        tree = child(theirs, prefix)
        if tree is not None:
            compare(Body(comparison, where, ours, tree))


def tshark_pdus(capture):
    command = ["tshark", "-r", str(capture), "-d", "udp.port==3000,dis", "-T", "json"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    pdus = {}
    for packet in json.loads(text, object_pairs_hook=lists):
        layers = packet["_source"][0]["layers"][0]
        if "dis" in layers:
            pdus[int(layers["frame"][0]["frame.number"][0])] = layers["dis"][0]
    return pdus


def our_pdus(program, capture):
    output = subprocess.run([program, "decode", str(capture)], check=True, capture_output=True, text=True).stdout
    pdus = {}
    for line in output.splitlines():
        pdu = json.loads(line)
        if pdu["offset"] == 0:
            pdus[pdu["frame"]] = pdu
    return pdus


def captures_in(arguments):
    for argument in map(pathlib.Path, arguments):
        yield from sorted(argument.glob("*.pcap")) if argument.is_dir() else [argument] * argument.exists()


def main():
    program, captures = sys.argv[1], list(captures_in(sys.argv[2:]))
    if shutil.which("tshark") is None or not captures:
        print("skipped: no tshark, or no captures here")
        return 77
    comparison = Comparison()
    pdus = refused = 0
    for capture in captures:
        theirs, ours = tshark_pdus(capture), our_pdus(program, capture)
        for frame in sorted(theirs.keys() | ours.keys()):
            where = f"{capture.name} frame {frame}"
            if frame not in ours or frame not in theirs:
                comparison.mismatches.append(f"{where}: only one of the two read it")
            elif "rejected" in ours[frame]:
                refused += 1
                print(f"{where}: refused by belvedere: {ours[frame]['rejected']}")
            else:
                pdus += 1
                compare_pdu(comparison, where, ours[frame], theirs[frame])
    for field, count in sorted(comparison.counts.items()):
        print(f"{field:28} {count}")
    for mismatch in comparison.mismatches:
        print(f"differs: {mismatch}")
    print(f"{len(captures)} captures, {pdus} PDUs compared, {refused} refused, {sum(comparison.counts.values())} fields "
          f"compared, {len(comparison.mismatches)} differ")
    return 1 if comparison.mismatches else 0


if __name__ == "__main__":
    sys.exit(main())
