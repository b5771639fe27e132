#!/usr/bin/env python3
"""Reads a hierarchy that `adamas resample --save` has written, and chooses a mesh from it, with h5py alone.

usage: read_hierarchy.py HIERARCHY.h5 INTERFACE_ERROR

Prints the number of tetrahedra of the smallest mesh that was certified within that error (in units of length), its
volume, and the names of the materials.
"""
import sys

import h5py
import numpy as np


def main():
    path, wanted = sys.argv[1], float(sys.argv[2])
    with h5py.File(path, "r") as file:
        vertices = file["tetrahedra/vertices"][:]
        positions = file["vertices/position"][:]
        split = file["diamonds/split tetrahedra"][:]
        first = file["diamonds/first"][:]
        errors = file["diamonds/certified interface error"][:]
        materials = [name.decode() for name in file["known/materials"][:]]
    roots = len(vertices) - 2 * len(split)
    # All tetrahedra of a diamond are split together; errors do not grow downwards, so that a diamond's parents are split
    # wherever it is. The children of split[i] are the tetrahedra roots + 2 i and roots + 2 i + 1.
    is_split = np.repeat(errors > wanted, np.diff(first))
    chosen = np.zeros(len(vertices), bool)
    chosen[:roots] = True
    children = roots + 2 * np.flatnonzero(is_split)
    chosen[children] = chosen[children + 1] = True
    chosen[split[is_split]] = False
    corners = positions[vertices[chosen]]
    edges = corners[:, 1:] - corners[:, :1]
    print("tetrahedra", int(chosen.sum()))
    print("volume", np.linalg.det(edges).sum() / 6)
    print("materials", ", ".join(materials))


if __name__ == "__main__":
    main()
