// Tables as CSV (RFC 4180).

/** Rows of cells as CSV; numbers are written so that they read back the same, null is empty. */
export function csvOf(rows) {
  return rows.map((cells) => cells.map(cellOf).join(",")).join("\r\n") + "\r\n";
}

function cellOf(value) {
  if (value === null || value === undefined) return "";
  const text = String(value);
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
