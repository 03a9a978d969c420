"""Reading frames and splits, and frames made of plain arrays for the other tests."""
import h5py
import numpy as np
import pytest

import synthetic
from rockbreak import measures
from rockbreak.errors import RockbreakError


def plain_frame(position, half=0.5, **given):
    """A Frame of squares with sides 2 `half`; contacts carry `force` 1 along the line of centres if not told."""
    position = np.asarray(position, dtype=float)
    n = len(position)
    a, b = np.asarray(given.pop("a", np.zeros(0, int))), np.asarray(given.pop("b", np.zeros(0, int)))
    branch = position[b] - position[a]
    normal = branch / np.linalg.norm(branch, axis=1)[:, None] if len(a) else np.zeros((0, 2))
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    values = dict(
        number=0, axial_strain=0.0, id=np.arange(n), parent=np.full(n, -1), root=np.arange(n),
        generation=np.zeros(n, int), position=position, angle=np.zeros(n), displacement=np.zeros((n, 2)),
        area=np.full(n, 4.0 * half ** 2), boundary=np.zeros(n, bool), offset=4 * np.arange(n + 1),
        body_vertices=np.tile(corners, (n, 1)), a=a, b=b, point=position[a] + 0.5 * branch, normal=normal, force=normal,
        normal_force=np.ones(len(a)), shear_force=np.zeros(len(a)), overlap_area=np.zeros(len(a)),
        ring=np.zeros(0, int))
    return measures.Frame(**(values | given))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return synthetic.write_run(tmp_path_factory.mktemp("run") / "r", frames=5)


def test_a_frame_file_is_read_as_it_stands(run):
    path = run / "frames" / "000003.h5"
    frame = measures.read_frame(path)
    with h5py.File(path) as file:
        assert (frame.number, frame.axial_strain) == (3, file.attrs["axial_strain"])
        assert (frame.id[frame.a] == file["contacts/a"][:]).all() and (frame.id[frame.b] == file["contacts/b"][:]).all()
        assert (frame.id[frame.ring] == file["boundary/ring"][:]).all()
        assert len(frame) == len(frame.outlines) == len(file["particles/id"])
        again = measures.read_frame(file)
    assert (again.position == frame.position).all() and again.boundary.dtype == bool
    areas = [synthetic.polygon_area(outline) for outline in frame.outlines]
    assert areas == pytest.approx(frame.area, rel=1e-12)


def test_outlines_stand_and_turn_in_the_world():
    frame = plain_frame([[3.0, 4.0], [7.0, 0.0]], angle=np.array([0.0, np.pi / 2]))
    assert frame.outlines[0] == pytest.approx(np.array([[2.5, 3.5], [3.5, 3.5], [3.5, 4.5], [2.5, 4.5]]))
    assert frame.outlines[1] == pytest.approx(np.array([[7.5, -0.5], [7.5, 0.5], [6.5, 0.5], [6.5, -0.5]]))


def test_rows_of_ids_that_are_gone_are_minus_one():
    frame = plain_frame(np.zeros((3, 2)), id=np.array([2, 5, 9]))
    assert frame.rows([5, 9, 2, 3, 10, 0]).tolist() == [1, 2, 0, -1, -1, -1]


def test_a_contact_state_of_another_program_needs_only_what_contacts_need(run, tmp_path):
    path = tmp_path / "f.h5"
    path.write_bytes((run / "frames" / "000000.h5").read_bytes())
    with synthetic.edited(path) as file:
        for name in ("particles/parent", "particles/root", "particles/generation", "particles/displacement",
                     "contacts/overlap_area", "boundary/ring"):
            del file[name]
    frame = measures.read_frame(path)
    assert (frame.parent == -1).all() and (frame.root == frame.id).all() and len(frame.ring) == 0
    with synthetic.edited(path) as file:
        del file["contacts/normal"]
    with pytest.raises(RockbreakError, match="contacts/normal"):
        measures.read_frame(path)


def test_a_damaged_frame_is_refused(run, tmp_path):
    path = tmp_path / "f.h5"
    content = bytearray((run / "frames" / "000000.h5").read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    with pytest.raises(RockbreakError, match="damaged"):
        measures.read_frame(path)


def test_a_split_file_is_read_as_it_stands(run):
    split = measures.read_split(run / "splits" / "000001.h5")
    assert split.number == 1 and len(split.broken) == 1 and split.path.shape == (1, 2, 2)
    assert (split.fragment_parent == split.broken[0]).all() and len(split.fragment_offset) == 3
