// A load on the bolt and the forces that balance it, as arrows beside the solids.

import * as THREE from "../third-party/three.module.js";

import { lineOfAction } from "./load.js";

const LOAD_COLOUR = 0xd81b60;
const FORCE_COLOUR = 0x1565c0;
const CONE_COLOUR = 0xf2b92f;
/** Lengths are in nominal diameters. An arrow of this length is a force as large as the load's. */
const LOAD_LENGTH = 0.42;
const LONGEST = 1.1;
const SHORTEST = 0.03;
const HEAD = 0.06;
const CONE_HEIGHT = 0.11;
const WIDEST_CONE = 0.2;
const POINT_RADIUS = 0.01;
/** Of a patch with many points no cones are drawn. */
const MOST_CONES = 8;

/** The marks of a loaded state, lengths in nominal diameters. */
export function forceMarks({ load, mu, wrenches, forces }, nominal) {
  const places = new Map(wrenches.map((one) => [one.contact, one]));
  const size = Math.hypot(...load.force);
  return [
    ...wrenches.map(({ point }) => ball(vector(point, nominal))),
    ...(wrenches.length <= MOST_CONES && mu > 0 ? wrenches.map((one) => cone(one, mu, nominal)) : []),
    ...forces.flatMap((one) => forceArrow(one, places.get(one.contact), size, nominal)),
    ...loadArrow(load, size, nominal),
  ];
}

/** The marks of a point of a path: its contacts with their forces, and the push (N) at the compliance centre, which is so high over the base. */
export function pointMarks({ contacts, pose }, { push, centre }, nominal) {
  const { rotation, translation } = pose;
  const held = new THREE.Vector3(...rotation.map((row, k) => translation[k] + row[2] * centre)).divideScalar(nominal);
  const down = new THREE.Vector3(0, 0, -1);
  return [
    ...contacts.map(({ point }) => ball(vector(point, nominal))),
    ...contacts.flatMap(({ point, force }) => scaledArrow(vector(point, nominal), new THREE.Vector3(...force), push)),
    ...(push > 0 ? [arrow(held.clone().addScaledVector(down, -LOAD_LENGTH), down, LOAD_LENGTH, LOAD_COLOUR)] : []),
  ];
}

function forceArrow({ normal, tangential }, { point, normal: along }, size, nominal) {
  const force = new THREE.Vector3(...along).multiplyScalar(normal).add(new THREE.Vector3(...tangential));
  return scaledArrow(vector(point, nominal), force, size);
}

/** A force as long as the load's arrow where it is as large as the load; none where it is much smaller. */
function scaledArrow(from, force, size) {
  if (size === 0 || force.length() < SHORTEST * size) return [];
  return [arrow(from, force, Math.min((LOAD_LENGTH * force.length()) / size, LONGEST), FORCE_COLOUR)];
}

/** The arrow ends on the load's line of action. */
function loadArrow(load, size, nominal) {
  if (size === 0) return [];
  const force = new THREE.Vector3(...load.force);
  const end = vector(load.point, nominal).add(vector(lineOfAction(load), nominal));
  return [arrow(end.clone().addScaledVector(force.clone().normalize(), -LOAD_LENGTH), force, LOAD_LENGTH, LOAD_COLOUR)];
}

function arrow(from, along, length, colour) {
  const mark = new THREE.ArrowHelper(along.clone().normalize(), from, length, colour, Math.min(HEAD, length / 2), HEAD / 2);
  mark.traverse((part) => {
    if (part.material) part.material.depthTest = false;
    part.renderOrder = 3;
  });
  return mark;
}

function ball(place) {
  const mark = new THREE.Mesh(new THREE.SphereGeometry(POINT_RADIUS, 16, 12), new THREE.MeshBasicMaterial({ color: FORCE_COLOUR, depthTest: false }));
  mark.position.copy(place);
  mark.renderOrder = 2;
  return mark;
}

/** A friction cone with its tip at the contact. */
function cone({ point, normal }, mu, nominal) {
  const height = Math.min(CONE_HEIGHT, WIDEST_CONE / mu);
  const geometry = new THREE.ConeGeometry(height * mu, height, 32, 1, true);
  geometry.translate(0, -height / 2, 0);
  const material = new THREE.MeshBasicMaterial({ color: CONE_COLOUR, transparent: true, opacity: 0.4, side: THREE.DoubleSide, depthTest: false });
  const mark = new THREE.Mesh(geometry, material);
  mark.quaternion.setFromUnitVectors(new THREE.Vector3(0, -1, 0), new THREE.Vector3(...normal));
  mark.position.copy(vector(point, nominal));
  mark.renderOrder = 1;
  return mark;
}

function vector(point, nominal) {
  return new THREE.Vector3(...point).divideScalar(nominal);
}
