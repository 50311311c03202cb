"""glTF files of spheres whose materials the comparison needs, and what a baked surface tells of its size."""
import json
import struct

import numpy

ROWS = {
    "plastic": [{"metallicFactor": 0, "roughnessFactor": r, "baseColorFactor": [0.6, 0.08, 0.05, 1]} for r in (0.1, 0.3, 0.6, 0.9)],
    "gold": [{"metallicFactor": 1, "roughnessFactor": r, "baseColorFactor": [1.0, 0.71, 0.29, 1]} for r in (0.1, 0.3, 0.6, 0.9)],
    "steel": [{"metallicFactor": m, "roughnessFactor": 0.35, "baseColorFactor": [0.56, 0.57, 0.58, 1]} for m in (0.0, 0.4, 0.7, 1.0)],
    "shine": [{"emissive": e, "metallicFactor": 0, "roughnessFactor": 0.8, "baseColorFactor": [0.2, 0.2, 0.2, 1]}
              for e in (0.25, 1.0, 4.0, 16.0)],
    "glass": [{"transmission": 1, "metallicFactor": 0, "roughnessFactor": r, "baseColorFactor": c}
              for r, c in ((0.0, [1, 1, 1, 1]), (0.0, [0.4, 0.8, 0.5, 1]), (0.4, [1, 1, 1, 1]), (0.0, [0.2, 0.2, 0.8, 1]))],
}


def sphere(rings=24, around=36):
    t = numpy.linspace(0, numpy.pi, rings + 1)
    p = numpy.linspace(0, 2 * numpy.pi, around + 1)
    normals = numpy.array([[numpy.sin(a) * numpy.cos(b), numpy.cos(a), numpy.sin(a) * numpy.sin(b)] for a in t for b in p])
    faces = []
    for i in range(rings):
        for j in range(around):
            a, b = i * (around + 1) + j, (i + 1) * (around + 1) + j
            faces += ([[a, a + 1, b]] if i else []) + ([[a + 1, b + 1, b]] if i + 1 < rings else [])
    return normals.astype("<f4"), numpy.array(faces, dtype="<u4")


def material(wanted):
    pbr = {k: v for k, v in wanted.items() if k.endswith("Factor")}
    made = {"pbrMetallicRoughness": pbr}
    if "emissive" in wanted:
        made["emissiveFactor"] = [1.0, 0.5, 0.15]
        made["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": wanted["emissive"]}}
    if "transmission" in wanted:
        made["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": wanted["transmission"]}}
    return made


def spheres(folder):
    """Writes a file a row, of four spheres beside each other."""
    normals, faces = sphere()
    data = normals.tobytes() + (normals * numpy.float32(0.5)).astype("<f4").tobytes() + faces.tobytes()
    n, f = normals.nbytes, faces.nbytes
    files = []
    for name, row in ROWS.items():
        used = sorted({e for m in row for e in material(m).get("extensions", {})})
        gltf = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(row)))}],
            "nodes": [{"mesh": i, "translation": [1.1 * (i - 1.5), 0.5, 0]} for i in range(len(row))],
            "meshes": [{"primitives": [{"attributes": {"NORMAL": 0, "POSITION": 1}, "indices": 2, "material": i}]} for i in range(len(row))],
            "materials": [material(m) for m in row],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(normals), "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5126, "count": len(normals), "type": "VEC3",
                           "min": [-0.5] * 3, "max": [0.5] * 3},
                          {"bufferView": 2, "componentType": 5125, "count": faces.size, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": n}, {"buffer": 0, "byteOffset": n, "byteLength": n},
                            {"buffer": 0, "byteOffset": 2 * n, "byteLength": f}],
            "buffers": [{"byteLength": len(data)}], "extensionsUsed": used,
        }
        text = json.dumps(gltf).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        files.append(folder / f"{name}.glb")
        files[-1].write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)
    return files


def bounds(surface):
    """Of all meshes of a baked surface, as its accessors state them."""
    with open(surface, "rb") as file:
        length = struct.unpack("<I", file.read(20)[12:16])[0]
        gltf = json.loads(file.read(length))
    boxes = [gltf["accessors"][p["attributes"]["POSITION"]] for m in gltf["meshes"] for p in m["primitives"]]
    return numpy.min([b["min"] for b in boxes], axis=0), numpy.max([b["max"] for b in boxes], axis=0)
