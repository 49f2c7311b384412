// A camera that orbits a point: azimuth and elevation in degrees, distance in nominal diameters.

import { DEFAULTS } from "./view.js";

const HIGHEST = 89;
const NEAREST = 0.15;
const FARTHEST = 12;
const DEGREES_PER_PIXEL = 0.4;
const KEY_STEP = 6;
const ZOOM_STEP = 1.12;

/** The camera that a page begins with. */
export function firstCamera() {
  const { azimuth, elevation, distance } = DEFAULTS;
  return { azimuth, elevation, distance };
}

/** The camera after a drag by so many pixels. */
export function dragged(camera, dx, dy) {
  return turned(camera, -dx * DEGREES_PER_PIXEL, dy * DEGREES_PER_PIXEL);
}

/** The camera nearer (`steps` above 0) or farther. */
export function zoomed(camera, steps) {
  const distance = camera.distance * ZOOM_STEP ** -steps;
  return { ...camera, distance: rounded(Math.min(Math.max(distance, NEAREST), FARTHEST)) };
}

/** The camera after a key, or null where the key means nothing. */
export function cameraAfterKey(camera, key) {
  switch (key) {
    case "ArrowLeft": return turned(camera, -KEY_STEP, 0);
    case "ArrowRight": return turned(camera, KEY_STEP, 0);
    case "ArrowUp": return turned(camera, 0, KEY_STEP);
    case "ArrowDown": return turned(camera, 0, -KEY_STEP);
    case "+": case "=": return zoomed(camera, 1);
    case "-": return zoomed(camera, -1);
    case "0": return firstCamera();
    default: return null;
  }
}

/** Where the camera stands about the origin, z up. */
export function cameraPosition({ azimuth, elevation, distance }) {
  const [a, e] = [azimuth, elevation].map((degrees) => (degrees * Math.PI) / 180);
  return [distance * Math.cos(e) * Math.cos(a), distance * Math.cos(e) * Math.sin(a), distance * Math.sin(e)];
}

function turned(camera, azimuth, elevation) {
  const next = (((camera.azimuth + azimuth + 180) % 360) + 360) % 360 - 180;
  return {
    ...camera,
    azimuth: rounded(next),
    elevation: rounded(Math.min(Math.max(camera.elevation + elevation, -HIGHEST), HIGHEST)),
  };
}

function rounded(value) {
  return Math.round(value * 1000) / 1000 + 0;
}
