#!/bin/bash
# Draco's default mesh encoding leaves out degenerate triangles, so that a decoded mesh has fewer than its accessor says.
#
# version    draco3d 1.5.9 (npm)
# guess      Quantisation moves vertices; the number of triangles stays.
# behaviour  MESH_EDGEBREAKER_ENCODING, which encoders choose by default, drops triangles that use a vertex twice, drops
#            vertices that no triangle uses and doubles vertices where the mesh is not a manifold.
#            MESH_SEQUENTIAL_ENCODING keeps every triangle. A triangle's number before compression therefore is not
#            its number after it, and the count in a glTF file can be larger than what the stream holds.
# seen       in: 4 triangles, 6 points; edgebreaker: 3 triangles, 7 points; sequential: 4 triangles, 5 points
# source     src/draco/mesh/corner_table.cc (degenerate faces are counted and skipped), used by
#            src/draco/compression/mesh/mesh_edgebreaker_encoder_impl.cc.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund draco3d@1.5.9 >> npm.log
cat > counts.mjs <<'JS'
import draco from 'draco3d';

const encoders = await draco.createEncoderModule({});
const decoders = await draco.createDecoderModule({});
// The third triangle uses vertex 1 twice; the fourth makes its edge 0-1 one of two triangles that do not share a side;
// no triangle uses the last vertices.
const positions = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 0, 5, 5, 5]);
const triangles = new Uint32Array([0, 1, 2, 1, 3, 2, 1, 1, 2, 0, 1, 3]);

function counts(method) {
  const mesh = new encoders.Mesh();
  const builder = new encoders.MeshBuilder();
  builder.AddFacesToMesh(mesh, triangles.length / 3, triangles);
  builder.AddFloatAttribute(mesh, encoders.POSITION, positions.length / 3, 3, positions);
  const encoder = new encoders.Encoder();
  encoder.SetEncodingMethod(method);
  const stream = new encoders.DracoInt8Array();
  const bytes = Int8Array.from({ length: encoder.EncodeMeshToDracoBuffer(mesh, stream) }, (_, i) => stream.GetValue(i));
  const buffer = new decoders.DecoderBuffer();
  buffer.Init(bytes, bytes.length);
  const decoded = new decoders.Mesh();
  if (!new decoders.Decoder().DecodeBufferToMesh(buffer, decoded).ok()) return 'not decoded';
  return `${decoded.num_faces()} triangles, ${decoded.num_points()} points`;
}
console.log(`in: ${triangles.length / 3} triangles, ${positions.length / 3} points; ` +
  `edgebreaker: ${counts(encoders.MESH_EDGEBREAKER_ENCODING)}; sequential: ${counts(encoders.MESH_SEQUENTIAL_ENCODING)}`);
JS
seen=$(node counts.mjs 2>&1)
echo "draco3d 1.5.9: $seen"
[ "$seen" = 'in: 4 triangles, 6 points; edgebreaker: 3 triangles, 7 points; sequential: 4 triangles, 5 points' ]
