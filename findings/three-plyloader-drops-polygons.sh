#!/bin/bash
# three.js's PLYLoader drops every face with more than four corners.
#
# version    three 0.187.0 (npm)
# guess      A pentagon in a PLY file becomes three triangles, or the loader says that it cannot read it.
# behaviour  Faces of three and four corners are kept. A face of five or more is left out, without an exception and
#            without a word on the console; where all faces are such, the geometry has no index and draws as loose
#            corners.
# seen       corners 3: triangles 1; corners 4: triangles 2; corners 5: triangles 0; corners 6: triangles 0
# source     examples/jsm/loaders/PLYLoader.js, handleElement: vertex_indices.length is compared with 3 and with 4 only.
#            The PLY format (Turk 1994) has lists of any length.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund three@0.187.0 >> npm.log
cat > polygons.mjs <<'JS'
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';

for (const name of ['log', 'warn', 'error']) {
  const print = console[name];
  console[name] = (...words) => { if (words[0] !== 'result') words = ['console.' + name, ...words]; print(...words); };
}
const results = [3, 4, 5, 6].map((corners) => {
  const angles = Array.from({ length: corners }, (_, i) => (2 * Math.PI * i) / corners);
  const file = ['ply', 'format ascii 1.0', `element vertex ${corners}`, 'property float x', 'property float y',
    'property float z', 'element face 1', 'property list uchar int vertex_indices', 'end_header',
    ...angles.map((a) => `${Math.cos(a)} ${Math.sin(a)} 0`),
    [corners, ...angles.keys()].join(' '), ''].join('\n');
  const geometry = new PLYLoader().parse(file);
  return `corners ${corners}: triangles ${geometry.index ? geometry.index.count / 3 : 0}`;
});
console.log('result', results.join('; '));
JS
seen=$(node polygons.mjs 2>&1)
echo "three 0.187.0, PLYLoader: $seen"
[ "$seen" = 'result corners 3: triangles 1; corners 4: triangles 2; corners 5: triangles 0; corners 6: triangles 0' ]
