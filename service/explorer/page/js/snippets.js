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
  const body = JSON.stringify(solveBody(library, pose));
  return `curl "${origin}/v1/solve?unit=${unit}" -H "Content-Type: application/json"${key} -d '${body}'`;
}

/** Python lines that fetch a state, with nothing but the standard library; where `keyed`, with the key in the variable KEY. */
export function pythonLines(origin, library, { pose, unit, stored }, keyed) {
  const own = stored ? [] : ['"Content-Type": "application/json"'];
  const headers = [...own, ...(keyed ? ['"Authorization": f"Bearer {os.environ[\'KEY\']}"'] : [])];
  const request = stored
    ? [`address = "${origin}${stateAddress(library, pose, unit)}"`, `request = urllib.request.Request(address, headers={${headers.join(", ")}})`]
    : [
        `body = json.dumps(${JSON.stringify(solveBody(library, pose))}).encode()`,
        `request = urllib.request.Request("${origin}/v1/solve?unit=${unit}", body, {${headers.join(", ")}})`,
      ];
  return [
    `import json, ${keyed ? "os, " : ""}urllib.request`,
    "",
    ...request,
    `state = json.load(urllib.request.urlopen(request))${stored ? "" : '["states"][0]'}`,
  ].join("\n");
}

function solveBody(library, { roll, pitch, phase }) {
  return { poses: [{ roll, pitch, phase }], designation: library.designation };
}
