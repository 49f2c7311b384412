// Text in lines of a picture.

/** Words in lines of at most `most` letters; what does not fit into `lines` lines ends in an ellipsis. */
export function wrapped(text, most, lines) {
  const found = [];
  for (const word of text.split(" ")) {
    const last = found.at(-1);
    if (last !== undefined && last.length + 1 + word.length <= most) found[found.length - 1] = `${last} ${word}`;
    else found.push(word);
  }
  if (found.length <= lines) return found;
  return [...found.slice(0, lines - 1), `${found[lines - 1].slice(0, most - 1)}…`];
}
