#!/bin/bash
# obj2gltf writes an emissiveFactor above 1, which glTF does not allow.
#
# version    obj2gltf 3.2.0, judged by gltf-validator 2.0.0-dev.3.10 (npm)
# guess      "Ke 2 0 0" becomes a factor of at most 1 and KHR_materials_emissive_strength, or is clamped with a word.
# behaviour  The numbers of Ke are copied. The file that comes out is invalid; readers that check ranges refuse it or
#            clamp it, others shine twice as bright.
# seen       "emissiveFactor":[2,0,0]; VALUE_NOT_IN_RANGE /materials/0/emissiveFactor/0
# source     lib/loadMtl.js (emissiveFactor is a copy of Ke); glTF 2.0, 5.19 Material: each element of
#            emissiveFactor is at most 1.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund obj2gltf@3.2.0 gltf-validator@2.0.0-dev.3.10 >> npm.log
printf 'newmtl lamp\nKd 0.2 0.2 0.2\nKe 2 0 0\n' > lamp.mtl
printf 'mtllib lamp.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n' > lamp.obj
node_modules/.bin/obj2gltf -i lamp.obj -o lamp.gltf > convert.log
cat > judge.mjs <<'JS'
import fs from 'node:fs';
import validator from 'gltf-validator';

const bytes = new Uint8Array(fs.readFileSync('lamp.gltf'));
console.log(JSON.stringify(JSON.parse(fs.readFileSync('lamp.gltf')).materials[0].emissiveFactor));
const report = await validator.validateBytes(bytes, { uri: 'lamp.gltf' });
for (const issue of report.issues.messages) if (issue.severity === 0) console.log(issue.code, issue.pointer);
JS
seen=$(node judge.mjs 2>&1)
echo "obj2gltf 3.2.0:"
echo "$seen"
[ "$seen" = $'[2,0,0]\nVALUE_NOT_IN_RANGE /materials/0/emissiveFactor/0' ]
