from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import igraph
import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.network.cell_maps import A, B, C, cell_maps, orientation_cells
from threadstate.network import export
from threadstate.network.cells import CellMap
from threadstate.network.graph import constraint_network

NETWORK = constraint_network(CellMap((0.0,), (orientation_cells(0, [10.0, 100.0, 200.0], [A, B, C]),)))
FORMATS = (export.node_link_json, export.graphml, export.dot)


def same_graph(one: nx.Graph[str], other: nx.Graph[str]) -> bool:
    return (
        type(one) is type(other) is nx.MultiDiGraph
        and dict(one.nodes(data=True)) == dict(other.nodes(data=True))
        and sorted(one.edges(keys=True, data=True), key=str) == sorted(other.edges(keys=True, data=True), key=str)
    )


@settings(max_examples=20)
@given(cell_maps())
def test_networkx_reads_the_same_network_back(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    graph = export.export_graph(network)
    assert same_graph(nx.node_link_graph(json.loads(export.node_link_json(network)), edges="edges"), graph)
    assert same_graph(nx.parse_graphml(export.graphml(network), force_multigraph=True), graph)


def test_igraph_reads_the_graphml(tmp_path: Path) -> None:
    path = tmp_path / "network.graphml"
    path.write_text(export.graphml(NETWORK), encoding="utf-8")
    graph = igraph.Graph.Read_GraphML(str(path))
    assert graph.is_directed()
    assert graph.vs["id"] == [node.formation.key for node in NETWORK.nodes]
    assert graph.vs["text"] == [node.formation.text for node in NETWORK.nodes]
    assert graph.vs["cover_deg"] == [node.cover_deg for node in NETWORK.nodes]
    ends = [(graph.vs[edge.source]["id"], graph.vs[edge.target]["id"], edge["move"]) for edge in graph.es]
    assert ends == [(edge.source.key, edge.target.key, edge.move.value) for edge in NETWORK.edges]


def test_dot_states_nodes_and_edges() -> None:
    lines = export.dot(NETWORK).splitlines()
    assert lines[0] == "digraph constraint_network {"
    assert lines[-1] == "}"
    assert len(lines) == 2 + len(NETWORK.nodes) + len(NETWORK.edges)
    assert (
        f'  "{A.key}" [label="unstable two-point:\\n1 negative flank on surface (edge-surface)\\n'
        '2 positive flank on negative flank (edge-edge)"];'
    ) in lines
    assert f'  "{A.key}" -> "{B.key}" [label="ccw", cover_deg="90.0"];' in lines


@given(st.text())
def test_a_quoted_string_of_dot_ends_at_its_last_quote(text: str) -> None:
    quoted = export.quoted(text)
    assert re.fullmatch(r'"(?:[^"\\\n]|\\[\\"n])*"', quoted)
    escapes = {"\\\\": "\\", '\\"': '"', "\\n": "\n"}
    assert re.sub(r"\\.", lambda found: escapes[found[0]], quoted[1:-1]) == text


@pytest.mark.slow
def test_bytes_do_not_depend_on_the_seed_of_hashes() -> None:
    code = (
        "import sys; from tests.network.test_export import FORMATS, NETWORK;"
        "sys.stdout.buffer.write(b''.join(text(NETWORK).encode() for text in FORMATS))"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, env={**os.environ, "PYTHONHASHSEED": seed}
        ).stdout
        for seed in ("1", "2")
    }
    assert outputs == {b"".join(text(NETWORK).encode() for text in FORMATS)}


def test_every_format_ends_with_a_newline() -> None:
    assert all(text(NETWORK).endswith(("}\n", "</graphml>\n")) for text in FORMATS)
