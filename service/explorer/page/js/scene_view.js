// Bolt and nut as shaded solids, their contacts, normals and pivot axis.

import * as THREE from "../third-party/three.module.js";

import { STAGE_COLOURS } from "./colours.js";
import { forceMarks, pointMarks } from "./force_marks.js";
import { meshesOf } from "./glb.js";
import { poseAt } from "./motion.js";
import { dragged, cameraAfterKey, cameraPosition, zoomed } from "./orbit.js";
import { lastStage } from "./resting.js";

const FIELD_OF_VIEW_DEG = 30;
const BOLT_COLOUR = 0x9fb4c7;
const NUT_COLOUR = 0xc9a86a;
const GLASS = 0.28;
const MARK_RADIUS = 0.014;
const NORMAL_LENGTH = 0.16;
const AXIS_REACH = 0.75;
const SAVED_PIXEL_RATIO = 2;
const SLOW_MS = 50;
/** How long the scene rests after a slow drawing, in times of what that took. */
const REST = 2;
const LONGEST_REST_MS = 600;
/** How long a drawing waits after it is asked for where they are slow: numbers and diagrams of the same change come first. */
const WAIT_MS = 120;
/** The scene looks at a point a little below the nut's surface, in nominal diameters. */
const TARGET = [0, 0, -0.03];

/** Whether this browser can draw solids at all. */
export function canDrawSolids() {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

/** The scene in a frame; `look` is called with a camera that was chosen. Lengths within are in nominal diameters. */
export class SceneView {
  canvas;
  #look;
  #renderer;
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.02, 60);
  #bolt = new THREE.Group();
  #nut = new THREE.Group();
  #marks = new THREE.Group();
  #cut = new THREE.Plane(new THREE.Vector3(1, 0, 0), 0);
  #view = null;
  #frame = null;
  #slow = false;
  #rested = 0;
  #description = "";

  constructor(frame, look) {
    this.#look = look;
    this.#renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.#renderer.localClippingEnabled = true;
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#camera.up.set(0, 0, 1);
    const sky = new THREE.HemisphereLight(0xffffff, 0x8d99a6, 1.6);
    sky.position.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
    sun.position.set(-0.6, -1, 1.4);
    this.#camera.add(sun);
    this.#scene.add(sky, this.#camera, this.#nut, this.#bolt, this.#marks);
    this.#bolt.matrixAutoUpdate = false;
    this.canvas = this.#renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    frame.replaceChildren(this.canvas);
    this.#listen();
    new ResizeObserver(() => this.#resize(frame)).observe(frame);
    this.#resize(frame);
  }

  /** Takes the solids of a pair, GLB files whose lengths are multiplied by `scale`. */
  setSolids(bolt, nut, scale) {
    const shaded = (colour, options) => new THREE.MeshLambertMaterial({ color: colour, ...options });
    fill(this.#bolt, bolt, scale, () => shaded(BOLT_COLOUR, {}));
    fill(this.#nut, nut, scale, () => shaded(NUT_COLOUR, { side: THREE.DoubleSide }));
    this.#draw();
  }

  /**
   * Shows a state (null: none) at the view's stage, from the view's camera, with its contacts, or what a load does to it (null: no
   * load); `description` is the picture in words.
   */
  show(state, loaded, view, threadPitch, nominal, description) {
    if (state === null) {
      this.#present(null, [], view, nominal, description);
      return;
    }
    const stage = Math.min(view.stage, lastStage(state));
    const marks = loaded === null ? stageMarks(state, stage, nominal) : forceMarks(loaded, nominal);
    this.#present(poseAt(state, stage, threadPitch), marks, view, nominal, description);
  }

  /** Shows a point {pose, contacts} of the path of a bolt, with the push and the compliance centre of its device. */
  showPoint(point, device, view, nominal, description) {
    this.#present(point.pose, pointMarks(point, device, nominal), view, nominal, description);
  }

  /** Shows the bolt at a pose (null: none) with marks. */
  #present(pose, marks, view, nominal, description) {
    this.#view = view;
    this.#description = description;
    this.#dressNut(view.nut);
    this.#bolt.visible = pose !== null;
    this.#clearMarks();
    if (pose !== null) this.#bolt.matrix.copy(matrixOf(pose, nominal));
    if (marks.length > 0) this.#marks.add(...marks);
    this.#draw();
  }

  /** The picture as it is now, as a PNG, twice as sharp as it is seen. */
  async png() {
    const ratio = this.#renderer.getPixelRatio();
    this.#renderer.setPixelRatio(SAVED_PIXEL_RATIO * ratio);
    this.#drawNow();
    // The bytes are read before the next drawing: the buffer does not outlive this task.
    const saved = new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
    this.#renderer.setPixelRatio(ratio);
    this.#drawNow();
    return saved;
  }

  #dressNut(look) {
    this.#nut.visible = look !== "off";
    this.#nut.traverse(({ material }) => {
      if (!material) return;
      const glass = look === "glass";
      if (material.transparent !== glass) material.needsUpdate = true;
      material.transparent = glass;
      material.opacity = glass ? GLASS : 1;
      material.depthWrite = !glass;
      material.clippingPlanes = look === "cut" ? [this.#cut] : [];
    });
  }

  #clearMarks() {
    this.#marks.traverse((mark) => {
      mark.geometry?.dispose();
      mark.material?.dispose();
    });
    this.#marks.clear();
  }

  /** Draws once, with the next frame of the page, however often it is requested until then. */
  #draw() {
    this.#frame ??= requestAnimationFrame((now) => {
      if (this.#slow) this.#rested = Math.max(this.#rested, now + WAIT_MS);
      this.#drawPaced(now);
    });
  }

  /** Where a drawing holds up the page, as without a graphics card, leaves time for everything else after it. */
  #drawPaced(now) {
    if (now < this.#rested) {
      this.#frame = requestAnimationFrame((later) => this.#drawPaced(later));
      return;
    }
    this.#drawNow();
    // A frame may still come while the drawing is in the works; the one after it is held up.
    requestAnimationFrame(() => requestAnimationFrame((next) => {
      const took = next - now;
      this.#slow = took > SLOW_MS;
      this.#rested = this.#slow ? next + Math.min(REST * took, LONGEST_REST_MS) : 0;
    }));
  }

  #drawNow() {
    cancelAnimationFrame(this.#frame);
    this.#frame = null;
    if (this.#view === null) return;
    const [x, y, z] = cameraPosition(this.#view);
    this.#camera.position.set(x + TARGET[0], y + TARGET[1], z + TARGET[2]);
    this.#camera.lookAt(...TARGET);
    const level = Math.hypot(x, y);
    this.#cut.normal.set(-x / level, -y / level, 0);
    this.#renderer.render(this.#scene, this.#camera);
    this.canvas.setAttribute("aria-label", `Bolt and nut, ${this.#description}; arrow keys orbit, plus and minus zoom, 0 resets`);
  }

  #resize(frame) {
    const { clientWidth: width, clientHeight: height } = frame;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#draw();
  }

  #listen() {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) this.#look(dragged(this.#view, event.movementX, event.movementY));
    });
    canvas.addEventListener("keydown", (event) => {
      const camera = cameraAfterKey(this.#view, event.key);
      if (camera === null) return;
      event.preventDefault();
      this.#look(camera);
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.#look(zoomed(this.#view, event.deltaY < 0 ? 1 : -1));
      },
      { passive: false },
    );
  }
}

function fill(group, glb, scale, material) {
  group.clear();
  for (const { name, positions, indices } of meshesOf(glb)) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions.map((value) => value * scale), 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    geometry.computeVertexNormals();
    const mesh = new THREE.Mesh(geometry, material());
    mesh.material.flatShading = name === "wall";
    group.add(mesh);
  }
}

/** The contacts that are made at a stage with their normals, and the pivot axis. */
function stageMarks(state, stage, nominal) {
  const reached = state.contacts.filter((contact) => contact.stage <= Math.floor(stage + 1e-9));
  const marks = reached.flatMap(({ point, normal, stage: made }) => {
    const place = new THREE.Vector3(...point).divideScalar(nominal);
    const colour = STAGE_COLOURS[made - 1];
    const ball = new THREE.Mesh(new THREE.SphereGeometry(MARK_RADIUS, 20, 14), new THREE.MeshBasicMaterial({ color: colour, depthTest: false }));
    ball.position.copy(place);
    ball.renderOrder = 2;
    return [ball, new THREE.ArrowHelper(new THREE.Vector3(...normal), place, NORMAL_LENGTH, colour, 0.05, 0.028)];
  });
  const second = reached.find((contact) => contact.stage === 2);
  return second ? [...marks, pivotAxis(state.contacts[0].point, second.point, nominal)] : marks;
}

function matrixOf({ rotation: [a, b, c], translation: [x, y, z] }, nominal) {
  return new THREE.Matrix4().set(...a, x / nominal, ...b, y / nominal, ...c, z / nominal, 0, 0, 0, 1);
}

function pivotAxis(first, second, nominal) {
  const [from, to] = [first, second].map((point) => new THREE.Vector3(...point).divideScalar(nominal));
  const along = to.clone().sub(from).normalize();
  const middle = from.clone().add(to).divideScalar(2);
  const ends = [-AXIS_REACH, AXIS_REACH].map((reach) => middle.clone().addScaledVector(along, reach));
  const material = new THREE.LineDashedMaterial({ color: 0xd81b60, dashSize: 0.04, gapSize: 0.02, depthTest: false });
  const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(ends), material);
  line.computeLineDistances();
  line.renderOrder = 1;
  return line;
}
