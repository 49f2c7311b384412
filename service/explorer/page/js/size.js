// Pictures that are drawn as large as their frames are.

/** Width and height of a frame in pixels, at least `least`; for a frame that is not laid out, `least` itself. */
export function sizeOf(frame, least) {
  return {
    width: Math.max(Math.floor(frame.clientWidth), least.width),
    height: Math.max(Math.floor(frame.clientHeight), least.height),
  };
}

/** Calls `changed` whenever the size of one of the frames has changed, or one is seen again: what it holds may have been drawn unseen. */
export function followSize(frames, changed) {
  const sizes = new Map(frames.map((frame) => [frame, `${frame.clientWidth} ${frame.clientHeight}`]));
  const observer = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const size = `${target.clientWidth} ${target.clientHeight}`;
      if (sizes.get(target) === size) continue;
      sizes.set(target, size);
      if (target.clientWidth > 0) changed(target);
    }
  });
  frames.forEach((frame) => observer.observe(frame));
}
