"""The network for other programs: node-link JSON, GraphML and DOT, the same bytes for the same network."""

from __future__ import annotations

import json

import networkx as nx

from threadstate.network.changes import difference
from threadstate.network.graph import ConstraintNetwork


def export_graph(network: ConstraintNetwork) -> nx.MultiDiGraph[str]:
    """The network with plain attributes, as every format can hold them.

    Nodes are formations' keys; edges are numbered e0, e1, ... in the network's order, which is their key in networkx.
    """
    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    for node in network.nodes:
        formation = node.formation
        graph.add_node(
            formation.key,
            text=formation.text,
            state_class=formation.state_class.value if formation.state_class else "undecided",
            contacts=len(formation.contacts),
            occurrences=len(node.cells),
            orientations=len(node.orientations),
            cover_deg=node.cover_deg,
            share=node.share,
            window_share=node.window_share,
        )
    for number, edge in enumerate(network.edges):
        graph.add_edge(
            edge.source.key,
            edge.target.key,
            key=f"e{number}",
            move=edge.move.value,
            change=difference(edge.source, edge.target).text,
            occurrences=len(edge.occurrences),
            orientations=len(edge.orientations),
            cover_deg=edge.cover_deg,
        )
    return graph


def node_link_json(network: ConstraintNetwork) -> str:
    """The network as node-link JSON, which ``networkx.node_link_graph(..., edges="edges")`` reads, in one line."""
    document = nx.node_link_data(export_graph(network), edges="edges")
    return json.dumps(document, separators=(",", ":"), allow_nan=False) + "\n"


def graphml(network: ConstraintNetwork) -> str:
    """The network as GraphML; ends with a newline."""
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + "\n".join(nx.generate_graphml(export_graph(network))) + "\n"


def dot(network: ConstraintNetwork) -> str:
    """The network in Graphviz's language; ends with a newline."""
    lines = ["digraph constraint_network {"]
    for node in network.nodes:
        label = f"{node.formation.text.replace('; ', chr(10)).replace(': ', ':' + chr(10), 1)}"
        lines.append(f"  {quoted(node.formation.key)} [label={quoted(label)}];")
    for edge in network.edges:
        attributes = f"label={quoted(edge.move)}, cover_deg={quoted(repr(edge.cover_deg))}"
        lines.append(f"  {quoted(edge.source.key)} -> {quoted(edge.target.key)} [{attributes}];")
    return "\n".join([*lines, "}"]) + "\n"


def quoted(text: str) -> str:
    r"""A quoted string of DOT: quotes and backslashes escaped, a line break as ``\n``."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
