#!/bin/bash
# gltf-transform's prune removes TANGENT although the material's anisotropy is directed by it.
#
# version    @gltf-transform/core, extensions and functions 4.5.1 (npm)
# guess      prune removes what no material uses; a material with KHR_materials_anisotropy uses tangents.
# behaviour  TANGENT is removed from every primitive whose material has no normal texture, also where an anisotropic
#            material without textures takes the direction of its highlights from TANGENT alone, and where there are no
#            texture coordinates left from which tangents could be made again. COLOR_0 stays.
# seen       before: POSITION NORMAL TEXCOORD_0 TANGENT COLOR_0; after: POSITION NORMAL COLOR_0
# source     packages/functions/src/prune.ts (tangents are kept for normal textures only); KHR_materials_anisotropy:
#            the direction of anisotropy lies in tangent space, from the mesh's TANGENT where it has one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y > npm.log
npm install --silent --no-audit --no-fund @gltf-transform/{core,extensions,functions}@4.5.1 >> npm.log
cat > prune.mjs <<'JS'
import { Document, Verbosity, Logger } from '@gltf-transform/core';
import { KHRMaterialsAnisotropy } from '@gltf-transform/extensions';
import { prune } from '@gltf-transform/functions';

const document = new Document().setLogger(new Logger(Verbosity.ERROR));
const buffer = document.createBuffer();
const material = document.createMaterial();
const anisotropy = document.createExtension(KHRMaterialsAnisotropy).createAnisotropy().setAnisotropyStrength(0.8);
material.setExtension('KHR_materials_anisotropy', anisotropy);
const primitive = document.createPrimitive().setMaterial(material);
const corners = (type, values) =>
  document.createAccessor().setType(type).setArray(new Float32Array([...values, ...values, ...values])).setBuffer(buffer);
primitive.setAttribute('POSITION',
  document.createAccessor().setType('VEC3').setArray(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])).setBuffer(buffer));
primitive.setAttribute('NORMAL', corners('VEC3', [0, 0, 1]));
primitive.setAttribute('TEXCOORD_0', corners('VEC2', [0.5, 0.5]));
primitive.setAttribute('TANGENT', corners('VEC4', [0, 1, 0, 1]));
primitive.setAttribute('COLOR_0', corners('VEC4', [1, 0, 0, 1]));
document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(primitive)));
const before = primitive.listSemantics().join(' ');
await document.transform(prune());
console.log(`before: ${before}; after: ${primitive.listSemantics().join(' ')}`);
JS
seen=$(node prune.mjs 2>&1)
echo "gltf-transform 4.5.1: $seen"
[ "$seen" = 'before: POSITION NORMAL TEXCOORD_0 TANGENT COLOR_0; after: POSITION NORMAL COLOR_0' ]
