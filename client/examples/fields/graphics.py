"""The curves inside a mesh, as tubes for Blender and as a graph of bones.
Usage: graphics.py MESH FOLDER"""

import sys

import bccskel

mesh, folder = sys.argv[1:]
bones = bccskel.skeletonize_mesh(bccskel.read(mesh), points=100_000)
bones.save(f"{folder}/bones.glb")
for one, other, length in bones.to_networkx().edges(data="length"):
    print(f"bone from node {one} to node {other}: {length:.3g} long")
