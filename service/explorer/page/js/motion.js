// The bolt on its way through the stages: down to the first contact, then a turn to each further one.

/** How high above its first contact the bolt begins, in thread pitches. */
const LIFT_IN_PITCHES = 0.8;

/**
 * The bolt's pose at a stage, whole or in between: {rotation, translation} as in the state. 0 is above the first contact,
 * 1 to 3 are the poses of the stages; between them the bolt turns about the axis on which its contacts lie.
 */
export function poseAt(state, stage, threadPitch) {
  const { poses, contacts } = state;
  if (stage < 1) {
    const [{ rotation, translation: [x, y, z] }] = poses;
    return { rotation, translation: [x, y, z + (1 - stage) * LIFT_IN_PITCHES * threadPitch] };
  }
  const before = poses[Math.min(Math.floor(stage), poses.length) - 1];
  const after = poses[Math.min(Math.floor(stage), poses.length - 1)];
  const along = stage - Math.floor(stage);
  if (along === 0 || before === after) return before;
  return turnedAbout(contacts[0].point, before, after, along);
}

/** The pose a part of the way from one pose to another, which differ by a turn about an axis through a point. */
function turnedAbout(fixed, before, after, along) {
  const difference = multiplied(after.rotation, transposed(before.rotation));
  const part = rotationAbout(axisOf(difference), angleOf(difference) * along);
  const arm = before.translation.map((value, k) => value - fixed[k]);
  return { rotation: multiplied(part, before.rotation), translation: applied(part, arm).map((value, k) => value + fixed[k]) };
}

function angleOf(rotation) {
  const [x, y, z] = skew(rotation);
  const trace = rotation[0][0] + rotation[1][1] + rotation[2][2];
  return Math.atan2(Math.hypot(x, y, z), trace - 1);
}

function axisOf(rotation) {
  const [x, y, z] = skew(rotation);
  const norm = Math.hypot(x, y, z) || 1;
  return [x / norm, y / norm, z / norm];
}

function skew(r) {
  return [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
}

function rotationAbout([x, y, z], angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const t = 1 - c;
  return [
    [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
    [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
    [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
  ];
}

function transposed(matrix) {
  return matrix[0].map((_, k) => matrix.map((row) => row[k]));
}

function applied(matrix, vector) {
  return matrix.map((row) => row.reduce((sum, value, k) => sum + value * vector[k], 0));
}

function multiplied(a, b) {
  const columns = transposed(b).map((column) => applied(a, column));
  return transposed(columns);
}
