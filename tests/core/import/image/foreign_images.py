"""Writes images with a program of others, for foreign_images_test.

Usage: foreign_images.py PROGRAM FOLDER
Voxel (x, y, z) is (7 x + 13 y + 29 z) % 100, and a quarter more for floats; bools are whether
x + y + z is odd.
Writes FOLDER/list.txt, a line for each image: name, voxel type, kind of values, size, the world
steps of the three axes and the origin, 0 0 0 0 where the format holds none. Exits with 77 where the
program is missing.
"""

import gzip
import pathlib
import subprocess
import sys

SIZE = (7, 5, 4)  # x, y, z
UNPLACED = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0))
INTEGERS = ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8"]
FLOATS = ["f4", "f8"]


def name_of(code):
    bits = 8 * int(code[1])
    return {"u": "uint", "i": "int", "f": "float"}[code[0]] + str(bits)


def voxels(code):
    """The array with index (z, y, x), in this machine's byte order."""
    z, y, x = numpy.meshgrid(*(numpy.arange(n) for n in SIZE[::-1]), indexing="ij")
    if code == "b1":
        return (x + y + z) % 2 == 1
    values = (7 * x + 13 * y + 29 * z) % 100
    return (values + (0.25 if code in FLOATS else 0)).astype(code)


class Folder:
    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.lines = []

    def add(self, name, code, placement=UNPLACED):
        """States what an image must be read as; returns its path."""
        kind = "bool" if code == "b1" else "quarter" if code in FLOATS else "whole"
        numbers = " ".join(repr(float(c)) for row in placement for c in row)
        scalar = "uint8" if code == "b1" else name_of(code)
        self.lines.append(f"{name} {scalar} {kind} {numbers}")
        return str(self.path / name)

    def write_list(self):
        (self.path / "list.txt").write_text("\n".join(self.lines) + "\n")


def write_numpy(folder):
    for code in INTEGERS + FLOATS:
        for order in "<>":
            array = voxels(code).astype(order + code)
            numpy.save(folder.add(f"{code}{'lb'[order == '>']}.npy", code), array)
            numpy.save(folder.add(f"{code}{'lb'[order == '>']}_fortran.npy", code),
                       numpy.asfortranarray(array))
    numpy.save(folder.add("bool.npy", "b1"), voxels("b1"))
    numpy.savez(folder.add("stored.npz", "u2"), mask=voxels("u2"))
    numpy.savez_compressed(folder.add("deflated.npz", "f4"), voxels("f4"))


def write_nibabel(folder):
    import nibabel
    turned = [[0, -2.0, 0, 10], [1.5, 0, 0, -20], [0, 0, 3, 30], [0, 0, 0, 1]]
    steps = ((0, 1.5, 0), (-2, 0, 0), (0, 0, 3), (10, -20, 30))
    # A rotation by quaternion, with the third axis turned over.
    tilt = nibabel.eulerangles.euler2mat(0.3, -0.2, 0.9) @ numpy.diag([1.0, 2.0, -3.0])
    tilted = numpy.eye(4)
    tilted[:3, :3], tilted[:3, 3] = tilt, (1, 2, 3)
    tilted_steps = (*(tuple(tilt[:, n]) for n in range(3)), (1, 2, 3))
    kinds = {"nii": nibabel.Nifti1Image, "n2": nibabel.Nifti2Image}
    for kind, image_class in kinds.items():
        for code in INTEGERS + FLOATS:
            for order in "<>":
                header = image_class.header_class(endianness=order)
                header.set_data_dtype(code)
                header.set_xyzt_units("mm")
                image = image_class(voxels(code).T.astype(code), turned, header)
                end = ".nii.gz" if order == "<" else ".nii"
                image.to_filename(folder.add(f"{kind}_{code}_{'lb'[order == '>']}{end}", code,
                                             steps))
        image = image_class(voxels("i2").T, None)
        image.set_qform(tilted, 1)
        image.set_sform(None, 0)
        image.to_filename(folder.add(f"{kind}_qform.nii", "i2", tilted_steps))
    pair = nibabel.Nifti1Pair(voxels("u2").T, turned)
    pair.to_filename(folder.add("pair.hdr", "u2", steps))
    folder.add("pair.img", "u2", steps)
    pair.to_filename(folder.add("packed.hdr.gz", "u2", steps))
    folder.add("packed.img.gz", "u2", steps)


def write_tifffile(folder):
    import tifffile
    for code in INTEGERS + FLOATS:
        for order in "<>":
            tifffile.imwrite(folder.add(f"{code}{'lb'[order == '>']}.tif", code), voxels(code),
                             byteorder=order, photometric="minisblack")
    tifffile.imwrite(folder.add("big.tif", "u2"), voxels("u2"), bigtiff=True,
                     photometric="minisblack")
    tifffile.imwrite(folder.add("tiles.tif", "u2"), voxels("u2"), tile=(16, 16),
                     photometric="minisblack")
    tifffile.imwrite(folder.add("strips.tif", "f4"), voxels("f4"), rowsperstrip=2,
                     photometric="minisblack")
    tifffile.imwrite(folder.add("bilevel.tif", "b1"), voxels("b1"), photometric="minisblack")
    tifffile.imwrite(folder.add("deflate.tif", "u2"), voxels("u2"), compression="zlib",
                     photometric="minisblack")
    tifffile.imwrite(folder.add("difference.tif", "u2"), voxels("u2"), compression="zlib",
                     predictor=True, photometric="minisblack")
    tifffile.imwrite(folder.add("white.tif", "u2"), voxels("u2"), photometric="miniswhite")
    tifffile.imwrite(folder.add("white_bilevel.tif", "b1"), voxels("b1"), photometric="miniswhite")
    with open(folder.path / "strips.tif", "rb") as plain:
        with gzip.open(folder.add("strips.tif.gz", "f4"), "wb") as packed:
            packed.write(plain.read())
    spaced = ((0.5, 0, 0), (0, 0.25, 0), (0, 0, 2), (0, 0, 0))
    tifffile.imwrite(folder.add("ome.tif", "u2", spaced), voxels("u2"), ome=True,
                     metadata={"axes": "ZYX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 0.25,
                               "PhysicalSizeZ": 2, "PhysicalSizeXUnit": "\u00b5m",
                               "PhysicalSizeYUnit": "\u00b5m", "PhysicalSizeZUnit": "\u00b5m"})
    tifffile.imwrite(folder.add("imagej.tif", "u2", spaced), voxels("u2"), imagej=True,
                     resolution=(2, 4), metadata={"axes": "ZYX", "spacing": 2, "unit": "um"})


def write_vtk(folder):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkNIFTIImageWriter, vtkTIFFWriter
    placed = ((0.5, 0, 0), (0, 1, 0), (0, 0, 2), (-1, 2, 5))

    def image_of(code):
        image = vtkImageData()
        image.SetDimensions(*SIZE)
        image.SetSpacing(0.5, 1, 2)
        image.SetOrigin(-1, 2, 5)
        image.GetPointData().SetScalars(numpy_to_vtk(voxels(code).ravel(), deep=True))
        return image

    def write(writer, path, code):
        writer.SetInputData(image_of(code))
        writer.SetFileName(path)
        writer.Write()

    for code in ["u1", "i1", "u2", "i2", "u4", "i4"] + FLOATS:
        packed, plain = vtkMetaImageWriter(), vtkMetaImageWriter()
        packed.SetCompression(True)
        plain.SetCompression(False)
        write(packed, folder.add(f"{code}.mha", code, placed), code)
        write(plain, folder.add(f"{code}.mhd", code, placed), code)
    write(vtkNIFTIImageWriter(), folder.add("vtk.nii.gz", "i2", placed), "i2")
    for number, name in enumerate(("none", "packbits", "deflate")):
        writer = vtkTIFFWriter()
        (writer.SetCompressionToNoCompression, writer.SetCompressionToPackBits,
         writer.SetCompressionToDeflate)[number]()
        write(writer, folder.add(f"vtk_{name}.tif", "u2"), "u2")


def write_teem(folder):
    placed = ((0.5, 0, 0), (0, 1, 0), (0, 0, 2), (-1, 2, 5))
    types = dict(zip(INTEGERS + FLOATS, ["uchar", "signed char", "ushort", "short", "uint", "int",
                                         "ulonglong", "longlong", "float", "double"]))
    for code, kind in types.items():
        for encoding, endian, end in (("raw", "little", "nrrd"), ("gzip", "big", "nrrd"),
                                      ("raw", "big", "nhdr"), ("gzip", "little", "nhdr")):
            path = folder.add(f"{code}_{encoding}_{endian}.{end}", code, placed)
            raw = folder.path / "input.raw"
            raw.write_bytes(voxels(code).tobytes())
            made = subprocess.run(
                ["teem-unu", "make", "-t", kind, "-s", *map(str, SIZE), "-i", str(raw), "-e",
                 "raw", "-en", "little", "-spc", "LPS", "-orig", "(-1,2,5)", "-dirs",
                 "(0.5,0,0) (0,1,0) (0,0,2)"], check=True, stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL)
            saved = ["teem-unu", "save", "-f", "nrrd", "-e", encoding, "-en", endian, "-o", path]
            subprocess.run(saved, input=made.stdout, check=True, stderr=subprocess.DEVNULL)


def write_zarr(folder):
    import numcodecs
    import zarr
    # Two chunks or more along each axis, the last ones cut by the border.
    chunks = (3, 2, 4)
    codecs = {"none": None, "zstd": numcodecs.Zstd(), "gzip": numcodecs.GZip(),
              "zlib": numcodecs.Zlib(), "lz4": numcodecs.LZ4()}
    codecs.update({f"blosc_{name}": numcodecs.Blosc(name, shuffle=numcodecs.Blosc.AUTOSHUFFLE)
                   for name in ("lz4", "lz4hc", "zstd", "zlib", "blosclz")})

    def write(name, code, endian="<", **options):
        array = voxels(code)
        if code != "b1":
            array = array.astype(endian + code)
        stored = zarr.open(folder.add(name, code), "w", shape=SIZE[::-1], dtype=array.dtype,
                           **{"chunks": chunks, **options})
        stored[...] = array

    for code in INTEGERS + FLOATS:
        for endian in "<>":
            for order in "CF":
                for separator in "./":
                    name = f"{code}{'lb'[endian == '>']}{order}{'ds'[separator == '/']}"
                    write(f"{name}.zarr", code, endian, order=order,
                          dimension_separator=separator)
    for name, codec in codecs.items():
        write(f"{name}.zarr", "u2", compressor=codec)
    write("bool.zarr", "b1")
    write("large_chunks.zarr", "i2", chunks=(64, 8, 9))
    # Chunks of one value are left out.
    image = zarr.open(folder.add("filled.zarr", "u2"), "w", shape=SIZE[::-1], chunks=chunks,
                      dtype="u2", fill_value=int(voxels("u2")[3, 4, 4]), write_empty_chunks=False)
    image[...] = voxels("u2")
    placed = ((0.5, 0, 0), (0, 0.25, 0), (0, 0, 2), (-3, 2, 40))
    for order in "CF":
        group = zarr.open_group(folder.add(f"placed_{order}.ome.zarr", "u2", placed), "w")
        group.create_dataset("full", data=voxels("u2")[None, None], chunks=(1, 1, *chunks),
                             order=order, dimension_separator="/")
        space = [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
        group.attrs["multiscales"] = [{
            "version": "0.4",
            "axes": [{"name": "t", "type": "time"}, {"name": "c", "type": "channel"}, *space],
            "datasets": [{"path": "full", "coordinateTransformations": [
                {"type": "scale", "scale": [1, 1, 1, 0.125, 0.25]},
                {"type": "translation", "translation": [0, 0, 20, 1, -1.5]}]}],
            "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 2, 2, 2]}]}]


PROGRAMS = {"numpy": write_numpy, "nibabel": write_nibabel, "tifffile": write_tifffile,
            "vtk": write_vtk, "teem": write_teem, "zarr": write_zarr}

if __name__ == "__main__":
    target = Folder(sys.argv[2])
    try:
        import numpy
        PROGRAMS[sys.argv[1]](target)
    except (ImportError, FileNotFoundError) as missing:
        print(missing)
        sys.exit(77)
    target.write_list()
