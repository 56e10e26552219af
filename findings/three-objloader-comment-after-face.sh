#!/bin/bash
# A comment behind a face makes three.js's OBJLoader add triangles whose corners are NaN.
#
# version    three 0.187.0 (npm)
# guess      "f 1 2 3 # the face" is the triangle 1 2 3: a comment may end any line.
# behaviour  The words of the comment are read as further corners of the polygon. One triangle becomes four, three of
#            them with NaN positions, which also make the bounding sphere NaN. Nothing is thrown, nothing is printed.
# seen       without a comment: 1 triangle, 0 NaN; with "# the face": 4 triangles, 15 NaN
# source     examples/jsm/loaders/OBJLoader.js, parse: the rest of a line that begins with "f" is split at blanks; only
#            lines that begin with "#" are comments. OBJ specification (Wavefront, appendix B1): comments can appear
#            anywhere in the file.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund three@0.187.0 >> npm.log
cat > comments.mjs <<'JS'
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';

function count(face) {
  const object = new OBJLoader().parse(`v 0 0 0\nv 1 0 0\nv 0 1 0\n${face}\n`);
  const positions = object.children[0].geometry.attributes.position;
  return `${positions.count / 3} triangles, ${positions.array.filter(Number.isNaN).length} NaN`;
}
console.log(`without: ${count('f 1 2 3')}; with: ${count('f 1 2 3 # the face')}`);
JS
seen=$(node comments.mjs 2>&1)
echo "three 0.187.0, OBJLoader: $seen"
[ "$seen" = 'without: 1 triangles, 0 NaN; with: 4 triangles, 15 NaN' ]
