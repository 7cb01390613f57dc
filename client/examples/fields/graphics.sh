#!/bin/sh
# The curves inside a mesh: tubes for Blender and browsers, and polylines. Usage: graphics.sh MESH FOLDER
set -eu
bccskel skeletonize "$1" --local --points 100k -o "$2/bones.glb" -o "$2/bones.obj"
