// Lines that fetch a state from the service.

/** The address of a state of the library. */
function stateAddress(library, pose, unit) {
  const own = library.stored_unit === unit ? "" : `?unit=${unit}`;
  return `/v1/libraries/${library.id}/states/${pose.roll}/${pose.pitch}/${pose.phase}${own}`;
}

/** A shell line that fetches a state. */
export function curlLine(origin, library, { pose, unit, stored }) {
  if (stored) return `curl "${origin}${stateAddress(library, pose, unit)}"`;
  const body = JSON.stringify(solveBody(library, pose));
  return `curl "${origin}/v1/solve?unit=${unit}" -H "Content-Type: application/json" -d '${body}'`;
}

/** Python lines that fetch a state, with nothing but the standard library. */
export function pythonLines(origin, library, { pose, unit, stored }) {
  if (stored) {
    return [
      "import json, urllib.request",
      "",
      `address = "${origin}${stateAddress(library, pose, unit)}"`,
      "state = json.load(urllib.request.urlopen(address))",
    ].join("\n");
  }
  return [
    "import json, urllib.request",
    "",
    `body = json.dumps(${JSON.stringify(solveBody(library, pose))}).encode()`,
    `request = urllib.request.Request("${origin}/v1/solve?unit=${unit}", body, {"Content-Type": "application/json"})`,
    'state = json.load(urllib.request.urlopen(request))["states"][0]',
  ].join("\n");
}

function solveBody(library, { roll, pitch, phase }) {
  return { poses: [{ roll, pitch, phase }], designation: library.designation };
}
