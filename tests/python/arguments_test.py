"""Wrong arguments are told in Python's way, and every option has a type."""

import gzip
import inspect
import pathlib
import warnings

import bccskel
import harness
import numpy
from bccskel import _native, _options

from shapes import ball, box_mesh

PACKAGE = pathlib.Path(bccskel.__file__).parent
MASK = ball(4)


def image_of(array):
    return bccskel.Image(array, (3, 2, 1), (7, 8, 9), numpy.eye(3), "mm")


class ArgumentsTest(harness.TestCase):
    def refuse(self, error, message, function, *arguments, **options):
        with self.assertRaises(error) as caught:
            function(*arguments, **options)
        self.assertEqual(str(caught.exception), message)

    def test_masks(self):
        refuse = lambda error, message, mask: self.refuse(error, message, bccskel.skeletonize, mask)
        refuse(ValueError, "mask must have 3 axes, got shape (5, 5): mask[None] is a stack of one slice",
               numpy.ones((5, 5)))
        refuse(TypeError, "mask must be an array, got a path: read('a.nii') reads the file", "a.nii")
        refuse(ValueError, "mask must not be empty, got shape (3, 0, 2)", numpy.ones((3, 0, 2)))
        refuse(TypeError, "mask must hold booleans or real numbers, got dtype complex128",
               numpy.ones((2, 2, 2), complex))
        refuse(TypeError, "mask must hold booleans or real numbers, got dtype object",
               numpy.full((2, 2, 2), None))
        self.refuse(ValueError, "image must have 3 axes, got shape (4,)",
                    bccskel.skeletonize_labels, [1, 2, 3, 4])

    def test_what_belongs_to_another_function_is_sent_there(self):
        mesh, image = bccskel.Mesh(*box_mesh()), image_of(MASK)
        refuse = lambda message, function, *given: self.refuse(TypeError, message, function, *given)
        refuse("mask must be an array, got a Mesh: skeletonize_mesh() takes it",
               bccskel.skeletonize, mesh)
        refuse("image must be an array, got a Mesh: skeletonize_mesh() takes it",
               bccskel.skeletonize_labels, mesh)
        refuse("mask must be an array of three axes, an Image or a Lattice, got NoneType",
               bccskel.skeletonize, None)
        refuse("image must be an array of three axes or an Image, got NoneType",
               bccskel.skeletonize_labels, None)
        refuse("mask must be an array of three axes, an Image or a Lattice, got Skeleton",
               bccskel.skeletonize, bccskel.skeletonize(MASK))
        for path in ("a.stl", pathlib.Path("a.stl")):
            refuse("vertices must be an array or a Mesh, got a path: read('a.stl') reads the file",
                   bccskel.skeletonize_mesh, path)
        refuse("vertices must be an array or a Mesh, got an Image: skeletonize() takes it",
               bccskel.skeletonize_mesh, image)
        refuse("vertices must be an array or a Mesh, got NoneType", bccskel.skeletonize_mesh, None)
        self.refuse(ValueError, "vertices must have shape (n, 3), got (11, 11, 11): skeletonize() takes "
                    "masks", bccskel.skeletonize_mesh, MASK, [[0, 1, 2]])

    def test_an_image_compares_as_its_array_and_keeps_its_place(self):
        image = image_of(MASK.astype("u1") * 3)
        self.assertEqual((image.shape, image.dtype, image.ndim), (MASK.shape, "u1", 3))
        for chosen in (image > 0, image == 3, image >= 3, (image > 1) & (image < 4), ~(image != 3),
                       (image == 3) | (image == 7)):
            self.assertIsInstance(chosen, bccskel.Image)
            numpy.testing.assert_array_equal(chosen, MASK)
            self.assertEqual((chosen.spacing, chosen.origin, chosen.unit), ((3, 2, 1), (7, 8, 9), "mm"))
        self.assertEqual(bccskel.skeletonize(image == 3).sha256, bccskel.skeletonize(image).sha256)
        with self.assertRaisesRegex(ValueError, r"an Image has no truth value.*\.array"):
            bool(image == 1)
        mesh = bccskel.Mesh(*box_mesh())
        self.assertEqual((mesh == mesh, mesh == bccskel.Mesh(*box_mesh())), (True, False))

    def test_places(self):
        refuse = lambda message, **places: self.refuse(ValueError, message, bccskel.skeletonize,
                                                       MASK, **places)
        refuse("spacing must be positive, got (1, 0, 1)", spacing=(1, 0, 1))
        refuse("spacing must be 3 finite numbers or one for all axes, got (1, 2)", spacing=(1, 2))
        refuse("origin must be 3 finite numbers or one for all axes, got nan",
               origin=float("nan"))
        refuse("axes must be 'zyx', 'xyz' or another order of them, got 'zzx'", axes="zzx")
        refuse("axes must be 'zyx', 'xyz' or another order of them, got None", axes=None)
        refuse("spacing must be 3 finite numbers or one for all axes, got 'wide'", spacing="wide")
        refuse("direction must be 3 perpendicular unit vectors, shape (3, 3)",
               direction=2 * numpy.eye(3))

    def test_labels_without_voxels_are_told(self):
        image = MASK.astype("u1") * 7
        with self.assertWarnsRegex(UserWarning, "^labels without voxels: 9, 70$"):
            self.assertEqual(list(bccskel.skeletonize_labels(image, labels=[7, 9, 70])), [7])
        with self.assertWarnsRegex(UserWarning, "^labels without voxels: 9$"):
            bccskel.skeletonize_labels(image, label=[7, 9])
        with self.assertWarnsRegex(UserWarning, "^labels without voxels: 9$"):
            bccskel.skeletonize_labels(image, labels={7, 9})

    def test_labels_that_are_all_too_small_are_told(self):
        image = MASK.astype("u1") * 7
        with self.assertWarnsRegex(UserWarning, "^no label has 10000 voxels or more$"):
            self.assertEqual(bccskel.skeletonize_labels(image, min_voxels=10000), {})

    def test_images_of_nibabel_are_told_apart(self):
        class Nifti:
            dataobj = MASK
        with self.assertRaisesRegex(TypeError, r"np.asarray\(mask.dataobj\) is its array, of axes='xyz'"):
            bccskel.skeletonize(Nifti())

    def test_options(self):
        refuse = lambda error, message, **options: self.refuse(
            error, message, bccskel.skeletonize, MASK, **options)
        refuse(TypeError, "skeletonize() got an unexpected keyword argument 'prunning'. "
               "Did you mean 'pruning'?", prunning="none")
        refuse(TypeError, "skeletonize() got an unexpected keyword argument 'output'", output="a")
        for other, ours in (("voxel_size", "spacing"), ("dust_threshold", "min_component")):
            refuse(TypeError, f"skeletonize() got an unexpected keyword argument {other!r}. "
                   f"Did you mean {ours!r}?", **{other: 3})
        self.refuse(TypeError, "skeletonize_labels() got an unexpected keyword argument "
                    "'dust_threshold'. Did you mean 'min_voxels'?",
                    bccskel.skeletonize_labels, MASK, dust_threshold=3)
        refuse(ValueError, "pruning all: must be significance, length, relative-length, "
               "persistence or none", pruning="all")
        refuse(ValueError, 'pruning_threshold is for a rule of pruning, not for pruning="none"',
               pruning="none", pruning_threshold=1)
        self.refuse(ValueError, "border is for images and volumes, not for a mesh",
                    bccskel.skeletonize_mesh, *box_mesh(), border="continues", points=2000)
        refuse(TypeError, "fill_cavities must be True or False, got 3", fill_cavities=3)
        refuse(TypeError, "method must be a number or a text, got True", method=True)
        refuse(ValueError, "threads must be a whole number from 0 to 1024, got -1", threads=-1)
        refuse(ValueError, "timeout must be a positive number of seconds, got 0", timeout=0)
        refuse(ValueError, "timeout must be a positive number of seconds, got '5'", timeout="5")
        refuse(TypeError, "progress must be a function of (done, total) or None, got bool",
               progress=True)
        refuse(ValueError, "no voxel has the label 7; the image has 1 label: 1", label=7)
        refuse(ValueError, "label=0: 0 is the background, whose voxels only range=(0, 0) selects", label=0)
        self.refuse(ValueError, "label=0: 0 is the background, whose voxels only skeletonize() with "
                    "range=(0, 0) selects", bccskel.skeletonize_labels, MASK.astype("u1"), label=0)
        refuse(ValueError, "label and threshold exclude each other", label=1, threshold=1)
        refuse(ValueError, "root must be 3 finite numbers, one per axis, got (1, 2)", root=(1, 2))
        refuse(ValueError, "root must be 3 finite numbers, one per axis, got 7", root=7)
        refuse(ValueError, "root must be 3 finite numbers, one per axis, got (nan, 0, 0)",
               root=(float("nan"), 0, 0))
        refuse(ValueError, "root must be 3 finite numbers, one per axis, got ('a', 0, 0)",
               root=("a", 0, 0))
        refuse(ValueError, "pruning_threshold wide: must be a number",
               pruning_threshold="wide")
        refuse(ValueError, "denoise=2.5: must be a whole number", denoise=2.5)
        self.refuse(ValueError, 'root="node:N" names a node of one skeleton; labels have many',
                    bccskel.skeletonize_labels, MASK, root="node:1")

    def test_wrong_labels_are_named_with_their_place_in_the_array(self):
        def refuse(value, text, kind, **axes):
            labels = numpy.zeros((4, 5, 6), kind)
            labels[2, 1, 3] = value
            with self.assertRaises(ValueError) as caught:
                bccskel.skeletonize_labels(labels, **axes)
            self.assertEqual(str(caught.exception),
                             f"voxel (2, 1, 3) is {text}; labels are whole numbers from 0 on")

        for axes in ("zyx", "xyz", "yxz"):
            refuse(-1, "-1", "i2", axes=axes)
            refuse(0.5, "0.5", "f4", axes=axes)
        refuse(1e20, "1e+20", "f8")
        refuse(-numpy.inf, "-inf", "f4")

    def test_flags_that_are_off_and_options_that_are_none_do_nothing(self):
        self.assertEqual(bccskel.skeletonize(MASK, fill_cavities=False, threshold=None).sha256,
                         bccskel.skeletonize(MASK).sha256)

    def test_options_override_those_of_a_preset(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            own = bccskel.skeletonize(MASK, preset="airway", fill_cavities=False, cut_loops=0,
                                      keep_largest=False)
        self.assertEqual(own.sha256, bccskel.skeletonize(MASK).sha256)
        self.assertEqual(own.options["cavities"], "kept")
        self.assertEqual(own.options["tunnel_cells"], 0)

    def test_meshes(self):
        vertices, faces = box_mesh()
        refuse = lambda error, message, *mesh: self.refuse(
            error, message, bccskel.skeletonize_mesh, *mesh)
        refuse(ValueError, "vertices must have shape (n, 3), got (8, 2)", vertices[:, :2], faces)
        refuse(ValueError, "vertices must be finite", vertices * numpy.inf, faces)
        refuse(ValueError, "faces must be indices of the 8 vertices, got 1 to 8", vertices,
               faces + 1)
        refuse(ValueError, "faces must be triangles, whole numbers of shape (m, 3), got shape "
               "(12, 3) and dtype float64", vertices, faces * 1.0)
        refuse(TypeError, "skeletonize_mesh() needs faces beside vertices", vertices)

    def test_messages_name_functions_and_arguments_of_python(self):
        labels = numpy.repeat(numpy.arange(1, 5, dtype="u1"), 75).reshape(3, 10, 10)
        labels[0, 0, :3] = 0
        with self.assertWarnsRegex(UserWarning, r"label selects some, and skeletonize_labels\(\) "
                                                "takes each by itself$"):
            skeleton = bccskel.skeletonize(labels)
        self.refuse(ValueError, "density: must be 0.01 to 1000, not 1000000000.0",
                    bccskel.skeletonize, MASK, sampling="nearest", density=1e9)
        path = self.path("ball.swc")
        for step in ("a", True):
            self.refuse(TypeError, f"swc_step must be a number or None, got {step!r}",
                        skeleton.save, path, swc_step=step)
        for label in (-1, 2 ** 64, 1.5, "a"):
            self.refuse(ValueError, "labels must be whole numbers from 0 to 2**64 - 1, "
                        f"got {label!r}", bccskel.save_labels, path, {label: skeleton})
        self.refuse(TypeError, "label 1 must have a Skeleton, got int", bccskel.save_labels, path,
                    {1: 7})
        self.refuse(TypeError, "skeletons must be a dict of skeletons by label, got list",
                    bccskel.save_labels, path, [skeleton])
        for tls in (5, ("a", "b"), (1, 2, 3)):
            self.refuse(ValueError, "tls must be None, True, a path or (authorities, certificate, "
                        "key)", bccskel.Client, tls=tls)
        bccskel.Client("unix:/nowhere", tls=False)

    def test_files(self):
        self.refuse(FileNotFoundError, "cannot open '/nowhere.npy': No such file or directory",
                    bccskel.read, "/nowhere.npy")
        self.refuse(FileNotFoundError, "cannot open '/nowhere': No such file or directory",
                    bccskel.read, "/nowhere")
        bomb = self.folder / "bomb.nrrd"
        bomb.write_bytes(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: gzip\n\n" +
                         gzip.compress(bytes(100)))
        with self.assertRaisesRegex(ValueError, "bomb.nrrd': .* holds more"):
            bccskel.read(bomb)
        with self.assertRaisesRegex(ValueError, r"read\(\) takes images"):
            bccskel.read(__file__)
        with self.assertRaisesRegex(ValueError, "there are .swc, "):
            bccskel.skeletonize(MASK).save(self.path("ball.xyz"))
        with self.assertRaises(FileNotFoundError):
            bccskel.skeletonize(MASK).save(self.path("none/ball.swc"))


class TypesTest(harness.TestCase):
    def test_every_option_has_a_type(self):
        for kind in ("mask", "labels", "mesh", "file"):
            typed = getattr(_options, f"{kind.capitalize()}Options").__annotations__
            self.assertEqual(set(typed), set(_native.option_names(kind)))

    def test_every_parameter_and_result_has_a_type(self):
        for name in ("skeletonize", "skeletonize_labels", "skeletonize_mesh", "read"):
            signature = inspect.signature(getattr(bccskel, name))
            for parameter in signature.parameters.values():
                self.assertNotIn(parameter.annotation, ("Any", inspect.Parameter.empty), parameter)
            self.assertNotIn(signature.return_annotation, ("Any", inspect.Signature.empty))
        self.assertTrue((PACKAGE / "py.typed").is_file())

    def test_the_client_has_the_same_functions(self):
        for name in ("skeletonize", "skeletonize_labels", "skeletonize_mesh"):
            self.assertEqual(inspect.signature(getattr(bccskel.Client("unix:/nowhere"), name)),
                             inspect.signature(getattr(bccskel, name)))

    def test_the_options_are_the_command_line_s(self):
        text = self.succeed("skeletonize", "--help")
        for kind in ("mask", "mesh"):
            for name in _native.option_names(kind):
                self.assertIn("--" + name.replace("_", "-"), text)


if __name__ == "__main__":
    harness.main()
