// The other side of bake/atlas: xatlas with its default options, as WebAssembly (npm's package watlas 1.0.1).
//
// usage: node xatlas.mjs NODE_MODULES MESH OUT
// MESH: points and triangles (uint32 each), 3 floats a point, 3 uint32 a triangle. Prints "seconds charts"; OUT gets of
// each triangle's corners u, v (float32, any scale), then of each triangle its chart (uint32, ~0: none).
import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, meshPath, outPath] = process.argv.slice(2);
const watlas = await import(pathToFileURL(resolve(modules, "watlas/dist/watlas.js")));
await watlas.Initialize();

const file = readFileSync(meshPath);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
const [points, triangles] = new Uint32Array(bytes, 0, 2);
const positions = new Float32Array(bytes, 8, points * 3);
const indices = new Uint32Array(bytes, 8 + points * 12, triangles * 3);

const started = process.cpuUsage();
const atlas = new watlas.Atlas();
atlas.addMesh({
    vertexPositionData: positions,
    vertexCount: points,
    vertexPositionStride: 12,
    indexData: indices,
    indexCount: triangles * 3,
});
atlas.generate();
const used = process.cpuUsage(started), seconds = (used.user + used.system) * 1e-6;

const mesh = atlas.getMesh(0);
const corners = new Uint32Array(mesh.indexCount);
mesh.getIndexArray(corners);
const uv = new Float32Array(triangles * 6), chart = new Uint32Array(triangles);
for (let i = 0; i < corners.length; ++i) {
    const vertex = mesh.getVertex(corners[i]);
    uv[i * 2] = vertex.uv[0];
    uv[i * 2 + 1] = vertex.uv[1];
    chart[Math.floor(i / 3)] = vertex.atlasIndex < 0 ? 0xffffffff : vertex.chartIndex;
}
writeFileSync(outPath, Buffer.concat([Buffer.from(uv.buffer), Buffer.from(chart.buffer)]));
console.log(`${seconds.toFixed(3)} ${atlas.chartCount}`);
