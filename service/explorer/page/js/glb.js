// Binary glTF: the triangles of each of its meshes.

const MAGIC = 0x46546c67;
const CHUNK_HEAD = 8;
const HEAD = 12;
const UNSIGNED = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array };

/** The meshes of a GLB file (ArrayBuffer): {name, positions, indices}, three numbers a vertex and three indices a triangle. */
export function meshesOf(buffer) {
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) throw new Error("not a GLB file");
  const jsonLength = view.getUint32(HEAD, true);
  const start = HEAD + CHUNK_HEAD;
  const scene = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, start, jsonLength)));
  const binary = start + jsonLength + CHUNK_HEAD;
  const numbers = (index, type, width) => {
    const { bufferView, byteOffset = 0, count } = scene.accessors[index];
    const offset = binary + (scene.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    return new type(buffer.slice(offset, offset + count * width * type.BYTES_PER_ELEMENT));
  };
  return scene.meshes.map(({ name, primitives: [{ attributes, indices }] }) => ({
    name,
    positions: numbers(attributes.POSITION, Float32Array, 3),
    indices: numbers(indices, UNSIGNED[scene.accessors[indices].componentType], 1),
  }));
}
