"""The network of made-up paths: its laws, and its numbers."""

from __future__ import annotations

import math
import random
from collections import Counter

import pytest

from tests.chances.made_up import EDGES, FLUSH, THREAD, record, records, visit
from threadstate.chances.model import Formation, Leaving, Record
from threadstate.chances.network import ChancesNetwork, network_of, quantile
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.errors import InvalidValueError

OUTCOMES = (AssemblyOutcome.ENGAGED, AssemblyOutcome.IDLE, AssemblyOutcome.UNDECIDED)


def random_records(seed: int) -> list[Record]:
    """Paths through the three formations at random."""
    chosen = random.Random(seed)
    found = []
    for index in range(chosen.randint(1, 30)):
        visits = []
        for k in range(chosen.randint(0, 6)):
            formation = chosen.choice((EDGES, THREAD, FLUSH))
            visits.append(visit(formation, -10.0 * k, -10.0 * (k + 1), chosen.choice((Leaving.GAINED, Leaving.FALL))))
        found.append(record(index, chosen.choice(OUTCOMES), *visits))
    return found


def checked(network: ChancesNetwork, given: list[Record]) -> None:
    """Check what holds of every network."""
    into = Counter[Formation | AssemblyOutcome]()
    for edge in network.edges:
        into[edge.target] += edge.moves.count
    for node in network.nodes:
        out = [edge.moves for edge in network.edges if edge.source == node.formation]
        assert math.fsum(move.share for move in out) == pytest.approx(1.0, abs=1e-12)
        assert sum(move.count for move in out) == node.visits == node.begins + into[node.formation]
        assert node.visited.count <= node.visits
        assert node.chance.of == node.visited.count
    ended = Counter(one.outcome for one in given)
    unvisited = Counter(one.outcome for one in given if not one.visits)
    assert {outcome: ends.count for outcome, ends in network.outcomes} == dict(ended)
    for outcome in ended:
        assert into[outcome] == ended[outcome] - unvisited[outcome]
    assert sum(node.begins for node in network.nodes) + network.unvisited == len(given)
    turned = math.fsum(node.turned_deg * node.visited.count for node in network.nodes)
    assert turned == pytest.approx(math.fsum(one.turned_deg or 0.0 for one in given))


@pytest.mark.parametrize("seed", range(20))
def test_laws_hold_of_any_paths(seed: int) -> None:
    given = random_records(seed)
    network = network_of(given)
    checked(network, given)
    shuffled = given[:]
    random.Random(seed).shuffle(shuffled)
    assert network_of(shuffled).nodes == network.nodes


def test_numbers_of_made_up_paths() -> None:
    network = network_of(records())
    checked(network, records())
    edges, thread, flush = network.nodes
    assert [node.formation for node in network.nodes] == [EDGES, THREAD, FLUSH]
    assert (edges.visited.count, edges.visits, edges.begins) == (3, 4, 3)
    assert edges.turned_deg == pytest.approx((90.0 + 30.0 + 30.0 + 270.0) / 3)
    assert edges.reached_deg == 0.0
    assert thread.reached_deg == pytest.approx((90.0 + 30.0) / 2)
    assert thread.torque == (0.1, 0.5)
    assert (thread.force_low, thread.force_high) == ((0.0, -2.0, 10.0), (1.0, 0.0, 10.0))
    assert thread.difference == pytest.approx(1.0 - 2 / 3)
    assert edges.difference == pytest.approx(0.0)
    assert flush.difference is None
    assert network.unvisited == 1
    assert network.bounded == 0
    moves = {(edge.source, edge.target, edge.left): edge.moves.share for edge in network.edges}
    assert moves == {
        (EDGES, THREAD, Leaving.GAINED): 0.5,
        (EDGES, THREAD, Leaving.FALL): 0.25,
        (EDGES, AssemblyOutcome.IDLE, Leaving.END): 0.25,
        (THREAD, AssemblyOutcome.ENGAGED, Leaving.END): pytest.approx(2 / 3),
        (THREAD, EDGES, Leaving.LOST): pytest.approx(1 / 3),
        (FLUSH, AssemblyOutcome.UNDECIDED, Leaving.END): 1.0,
    }


def test_formations_that_tell_most_come_first_and_undecided_ones_not_at_all() -> None:
    assert [node.formation for node in network_of(records()).telling] == [THREAD, EDGES]


def test_a_difference_is_distinct_where_the_interval_excludes_the_share_of_all() -> None:
    thread, edges = visit(THREAD, 0.0, -9.0, Leaving.END), visit(EDGES, 0.0, -9.0, Leaving.END)
    few = [record(0, AssemblyOutcome.ENGAGED, thread), record(1, AssemblyOutcome.IDLE, edges)]
    assert not any(node.is_distinct for node in network_of(few).nodes)
    many = [record(index, AssemblyOutcome.ENGAGED, thread) for index in range(10)]
    many += [record(index, AssemblyOutcome.IDLE, edges) for index in range(10, 20)]
    assert all(node.is_distinct for node in network_of(many).nodes)


def test_turning_to_assembly_is_that_of_the_paths_that_engage() -> None:
    turning = network_of(records()).turning
    assert turning is not None
    assert (turning.paths, turning.mean_deg) == (2, 150.0)
    assert turning.quantiles_deg == pytest.approx((110.0, 150.0, 190.0))
    assert quantile([7.0], 0.9) == 7.0


def test_without_an_engaged_path_there_is_no_turning() -> None:
    assert network_of(records()[2:]).turning is None


def test_where_all_are_undecided_nothing_tells() -> None:
    network = network_of(records()[3:])
    checked(network, records()[3:])
    assert (network.telling, network.turning, network.chance.share) == ((), None, None)


def test_a_network_needs_a_path() -> None:
    with pytest.raises(InvalidValueError, match="samples is 0; valid: one or more"):
        network_of([])
