#!/usr/bin/env python3
"""Writes small good and nearly good files, from which the fuzzers of the scene readers start.

usage: scene_seeds.py FOLDER     makes FOLDER/fuzz_scene_obj/..., one folder a target
"""
import base64
import json
import pathlib
import struct
import sys

CORNERS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def obj_seeds():
    """OBJ: every statement, every form of a corner."""
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
    yield vertices + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES)
    yield (vertices + "vt 0 0\nvn 0 0 1\nvn 0 1 0\no a\ng b\ns 1\nusemtl m\nmtllib m.mtl\n"
           "f 1/1/1 2/1/1 3/1/2\nf 1//1 2//2 3//1\nf -1 -2 -3 -4\ns off\nf 1/1 2/1 3/1\n")
    yield "v 1e-45 -3.4028235e38 +.5 1\r\nv 0 0 0 0 0 0\r\nf 1 2 \\\r\n1\r\nl 1 2\np 1\n# end"
    yield vertices + "f 1 2 9\nv nan 0 0\n"


def mtl_seeds():
    """MTL: every statement and illumination model."""
    yield ("newmtl a\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 0.1\nKe 2 0 0\nNs 10\nNi 1.5\nd 0.5\nillum 2\n"
           "newmtl b\nTr 0.5\nTf 1 1 1\nillum 7\nmap_Kd -s 1 1 1 a.png\nKd spectral f.rfl\n")
    yield "".join(f"newmtl m{i}\nKd 1 0 0\nKs 0 1 0\nillum {i}\n" for i in range(11))


def ply_seeds():
    """PLY: text, both byte orders, lists and unknown elements."""
    header = ("ply\nformat {} 1.0\ncomment c\nelement vertex 4\nproperty float x\n"
              "property double y\nproperty float z\nproperty uchar red\nelement face 4\n"
              "property list uchar int vertex_indices\nelement edge 1\nproperty short a\n"
              "end_header\n")
    text = header.format("ascii")
    text += "".join(f"{x} {y} {z} 7\n" for x, y, z in CORNERS)
    text += "".join(f"3 {a} {b} {c}\n" for a, b, c in FACES) + "5\n"
    yield text
    yield text.replace("uchar red", "float nx").replace("\n", "\r\n")
    for order, mark in (("little", "<"), ("big", ">")):
        data = header.format(f"binary_{order}_endian").encode()
        data += b"".join(struct.pack(mark + "fdfB", x, y, z, 7) for x, y, z in CORNERS)
        data += b"".join(struct.pack(mark + "Biii", 3, *face) for face in FACES)
        yield data + struct.pack(mark + "h", 5)


def stl_seeds():
    """STL: text and binary."""
    text = "solid a b\n"
    data = b"solid".ljust(80) + struct.pack("<I", len(FACES))
    for face in FACES:
        text += "facet normal 0 0 1\nouter loop\n"
        data += struct.pack("<3f", 0, 0, 1)
        for corner in face:
            text += "vertex {} {} {}\n".format(*CORNERS[corner])
            data += struct.pack("<3f", *CORNERS[corner])
        text += "endloop\nendfacet\n"
        data += b"\0\0"
    yield text + "endsolid a b\n"
    yield data


def gltf_parts():
    """A document with nodes, materials, a light and a camera, and its buffer."""
    buffer = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)
    buffer += b"".join(struct.pack("<3H", *face) for face in FACES)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 2, 3], "children": [1, 2, 3]},
                  {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
                  {"camera": 0, "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": 0},
            {"attributes": {"POSITION": 0}, "mode": 5}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.5],
                                                "metallicFactor": 0.5, "roughnessFactor": 0.1},
                       "emissiveFactor": [0, 0, 0], "alphaMode": "BLEND",
                       "extensions": {"KHR_materials_ior": {"ior": 1.3},
                                      "KHR_materials_transmission": {"transmissionFactor": 1}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "color": [1, 1, 1], "intensity": 5}]}},
        "buffers": [{"byteLength": len(buffer)}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}]}
    return document, buffer


def gltf_seeds():
    """glTF: the document, a NUL, and the file "b"; or the buffer within the document."""
    document, buffer = gltf_parts()
    document["buffers"][0]["uri"] = "b"
    yield json.dumps(document, separators=(",", ":")).encode() + b"\0" + buffer
    document["buffers"][0]["uri"] = "data:;base64," + base64.b64encode(buffer).decode()
    yield json.dumps(document, separators=(",", ":"))


def glb_seeds():
    """GLB: with and without a BIN chunk."""
    document, buffer = gltf_parts()
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    for chunks in ([(b"JSON", text), (b"BIN\0", buffer)], [(b"JSON", text)]):
        body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
        yield b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def toml_seeds():
    """TOML: every table and key."""
    yield ("background = [0.1, 0.2, 0.3]\nambient = 1\n[camera]\neye = [0, 1, 5]\n"
           "look = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[[light]]\ntype = \"point\"\n"
           "position = [1, 2, 3]\ncolour = 1\nintensity = 0.5\n[[light]]\ntype = \"directional\"\n"
           "direction = [0, -1, 0]\n[[material]]\nname = \"a\"\ndiffuse = [1, 0, 0]\nior = 1.5\n"
           "[[mesh]]\nfile = \"t.obj\"\nmaterial = \"a\"\nsmooth = true\nscale = 2\n"
           "rotate = [0, 1, 0, 45]\ntranslate = [1, 0, 0]\n")
    yield ("[[mesh]]\nfile = \"builtin:cube?size=1,1,1\"\n"
           "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n"
           "instances = [{}, {scale = [1, 2, 3]}, {translate = [0, 0, 1e3]}]\n")


def main():
    """Writes all seeds."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for kind in ("obj", "mtl", "ply", "stl", "gltf", "glb", "toml"):
        folder = pathlib.Path(sys.argv[1]) / f"fuzz_scene_{kind}"
        folder.mkdir(parents=True, exist_ok=True)
        for number, seed in enumerate(globals()[f"{kind}_seeds"]()):
            content = seed.encode() if isinstance(seed, str) else seed
            (folder / f"seed{number}").write_bytes(content)


if __name__ == "__main__":
    main()
