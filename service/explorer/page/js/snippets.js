// Lines that fetch a state from the service.

/** The address of a state of the library. */
function stateAddress(library, pose, unit) {
  const own = library.stored_unit === unit ? "" : `?unit=${unit}`;
  return `/v1/libraries/${library.id}/states/${pose.roll}/${pose.pitch}/${pose.phase}${own}`;
}

/** A shell line that fetches a state; where `keyed`, with the key that the variable KEY has. */
export function curlLine(origin, library, { pose, unit, stored }, keyed) {
  const key = keyed ? ' -H "Authorization: Bearer $KEY"' : "";
  if (stored) return `curl "${origin}${stateAddress(library, pose, unit)}"${key}`;
  const { roll, pitch, phase } = pose;
  const body = JSON.stringify({ library: library.id, poses: [{ roll, pitch, phase }] });
  return `curl "${origin}/v1/solve?unit=${unit}" -H "Content-Type: application/json"${key} -d '${body}'`;
}

/** Python lines that fetch a state with the project's client; where `keyed`, with the key in the variable KEY. */
export function pythonLines(origin, library, { pose: { roll, pitch, phase }, unit, stored }, keyed) {
  const client = keyed ? `Client("${origin}", key=os.environ["KEY"])` : `Client("${origin}")`;
  const which = `library=${library.id}, unit="${unit}"`;
  const state = stored ? `client.state(${roll}, ${pitch}, ${phase}, ${which})` : `client.solve([(${roll}, ${pitch}, ${phase})], ${which}).states[0]`;
  return [
    ...(keyed ? ["import os", ""] : []),
    "from threadstate.client import Client",
    "",
    `with ${client} as client:`,
    `    state = ${state}`,
    "print(state.state_class, state.poses[-1].translation)",
  ].join("\n");
}
