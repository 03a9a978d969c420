"""Run directories made of thin air: the files of INTERFACES with known numbers in them, for tests of the pipeline."""
import json
from contextlib import contextmanager

import h5py
import numpy as np
import yaml

from rockbreak.run.payload_hash import payload_hash
from rockbreak.sealed import SEAL_BYTES, seal_of

CASE = {
    "seed": 1,
    "effects": ["friction", "local_damping", "energy_ledger", "breakage"],
    "assembly": {"particles": 48, "diameter_min": 0.37, "diameter_max": 0.57},
    "preparation": {"confining_pressure": 2.0e6, "void_ratio": 0.3},
    "shear": {"axial_strain": 0.10, "strain_rate": 0.02},
    "breakage": {"interval": 0.005},
    "output": {"keep_frames": "all"},
}


def seal(path):
    """Adds the payload hash and the seal, as the writers of frames and splits do."""
    with h5py.File(path, "a") as file:
        value = file.attrs["payload_hash"] = payload_hash(file)
    image = path.read_bytes()
    path.write_bytes(image + seal_of(image))
    return value


@contextmanager
def edited(path):
    """An open file to change, sealed anew afterwards."""
    path.write_bytes(path.read_bytes()[:-SEAL_BYTES])
    with h5py.File(path, "a") as file:
        yield file
    seal(path)


def contacts_of_known_anisotropy(count, a, a_n, a_t, theta_0=np.pi / 2, theta_n=np.pi / 2, theta_t=np.pi / 2, f0=1e6):
    """Normals at the quantiles of Eq. 7, forces exactly on Eqs. 8 and 9."""
    grid = np.linspace(0, np.pi, 200001)
    cumulative = grid + a / 2 * (np.sin(2 * (grid - theta_0)) + np.sin(2 * theta_0))
    theta = np.interp((np.arange(count) + 0.5) / count * np.pi, cumulative, grid)
    normal = np.column_stack([np.cos(theta), np.sin(theta)])
    return (normal, f0 * (1 + a_n * np.cos(2 * (theta - theta_n))), f0 * a_t * np.sin(2 * (theta - theta_t)))


def hexagon(radius, turn):
    corners = turn + np.arange(6) * np.pi / 3
    return radius * np.column_stack([np.cos(corners), np.sin(corners)])


class Assembly:
    """A patch of hexagons on a triangular grid. A broken one becomes two halves."""

    def __init__(self, columns=8, rows=6, seed=1):
        rng = np.random.default_rng(seed)
        x, y = np.meshgrid(np.arange(columns) * 0.45, np.arange(rows) * 0.39)
        x = x + 0.225 * (np.arange(rows)[:, None] % 2)
        self.origin = np.column_stack([x.ravel(), y.ravel()])
        count = len(self.origin)
        self.id = np.arange(count)
        self.parent = np.full(count, -1)
        self.outline = [hexagon(0.22, turn) for turn in rng.uniform(0, 1, count)]
        edge = (x.ravel() < 0.3) | (x.ravel() > x.max() - 0.3) | (y.ravel() < 0.1) | (y.ravel() > y.max() - 0.1)
        self.boundary = edge.astype(np.uint8)
        self.next_id = count

    def break_one(self, index):
        """Along the body's diagonal through corners 0 and 3. Returns what a split says of it."""
        outline, parent = self.outline[index], self.id[index]
        halves = [outline[[0, 1, 2, 3]], outline[[3, 4, 5, 0]]]
        made = {"parent": parent, "path": outline[[0, 3]], "id": [self.next_id, self.next_id + 1], "halves": halves}
        keep = np.arange(len(self.id)) != index
        centroids = [np.mean(half, axis=0) for half in halves]
        self.origin = np.vstack([self.origin[keep], [self.origin[index] + c for c in centroids]])
        self.outline = [o for o, k in zip(self.outline, keep) if k] + [h - c for h, c in zip(halves, centroids)]
        self.id = np.append(self.id[keep], made["id"])
        self.parent = np.append(self.parent[keep], [parent, parent])
        self.boundary = np.append(self.boundary[keep], [0, 0])
        self.next_id += 2
        return made


def polygon_area(outline):
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def history_rows(first_step, strains, pressure, particles, contacts):
    """A smooth dense-sample response: sin(phi) peaks at 4 % axial strain with 0.5 and falls towards 0.4."""
    n = len(strains)
    sin_phi = np.where(strains < 0.04, 0.5 * np.sin(np.pi / 2 * strains / 0.04), 0.4 + 0.1 * np.exp(
        -(strains - 0.04) / 0.02))
    work = pressure * strains * 20
    ones = np.ones(n)
    columns = {
        "step": first_step + np.arange(n), "time": strains / 0.02, "axial_strain": strains,
        "lateral_strain": -0.9 * strains, "volumetric_strain": 0.01 * strains - strains ** 2,
        "stress_xx": pressure * (1 + 0.01 * np.cos(np.pi * np.arange(n))), "stress_xy": 0 * ones,
        "void_ratio": 0.30 + 0.3 * strains, "void_ratio_e1": 0.20 + 0.3 * strains,
        "void_ratio_e2": 0.21 + 0.3 * strains, "void_ratio_e4": 0.30 + 0.3 * strains,
        "assembly_area": 20 * ones, "solid_area": 15 * ones, "particles": particles * ones,
        "contacts": contacts * ones, "kinetic_energy": 5 * ones, "boundary_work": work,
        "friction_dissipation": 0.6 * work, "damping_dissipation": 0.1 * work, "elastic_energy": 0.2 * work,
        "contact_law_work": 0.05 * work, "released_by_breakage": 0.04 * work, "energy_residual": 0.01 * work,
        "unbalanced_force": 5e-4 + 0.01 * strains, "sliding_fraction": 0.1 * ones, "inertial_number": 4e-4 * ones,
        "contact_steps": 1000.0 * (first_step + np.arange(n)), "momentum_error": 1e-15 * ones,
    }
    columns["stress_yy"] = columns["stress_xx"] * (1 + sin_phi) / (1 - sin_phi)
    return {name: values.astype(float) for name, values in columns.items()}


def write_frame(path, assembly, k, strain, final, contacts, history, step=0):
    area = np.array([polygon_area(outline) for outline in assembly.outline])
    position = assembly.origin * np.array([1 + 0.9 * strain, 1 - strain])
    n = len(area)
    normal, normal_force, shear_force = contacts
    c = len(normal)
    rng = np.random.default_rng(k)
    pairs = neighbours(position)
    pair = pairs[rng.integers(0, len(pairs), c)]
    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    data = {
        "particles/id": assembly.id, "particles/parent": assembly.parent, "particles/root": assembly.id,
        "particles/generation": (assembly.parent >= 0).astype(np.int32),
        "particles/type": np.where(assembly.parent >= 0, -1, 0).astype(np.int32), "particles/position": position,
        "particles/velocity": 0 * position, "particles/displacement": position - assembly.origin,
        "particles/angle": np.zeros(n), "particles/angular_velocity": np.zeros(n), "particles/mass": 2500 * area,
        "particles/inertia": area ** 2, "particles/area": area, "particles/boundary": assembly.boundary,
        "particles/vertex_offset": np.cumsum([0] + [len(outline) for outline in assembly.outline]),
        "particles/vertices": np.vstack(assembly.outline),
        "contacts/a": assembly.id[pair.min(axis=1)], "contacts/b": assembly.id[pair.max(axis=1)],
        "contacts/point": position[pair].mean(axis=1), "contacts/normal": normal,
        "contacts/force": normal_force[:, None] * normal + shear_force[:, None] * tangent,
        "contacts/normal_force": normal_force, "contacts/shear_force": shear_force,
        "contacts/overlap_area": np.full(c, 1e-4), "contacts/overlap_width": np.full(c, 1e-2),
        "boundary/ring": assembly.id[assembly.boundary == 1],
        **{f"history/{name}": values for name, values in history.items()},
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    with h5py.File(path, "w") as file:
        for name, values in data.items():
            file.create_dataset(name, data=values)
        file.attrs.update({"schema": "frame/1", "frame": k, "step": step, "time": strain / 0.02, "stage": "shear",
                           "axial_strain": strain, "seed": 1, "next_id": assembly.next_id, "friction": 0.5,
                           "final": int(final), "config_hash": "c" * 32})
    return seal(path)


def neighbours(position):
    distance = np.hypot(*(position[:, None] - position[None]).transpose(2, 0, 1))
    i, j = np.nonzero((distance < 0.6) & (distance > 0))
    return np.column_stack([i, j])[i < j]


def write_split(path, k, frame_hash, ids, made, refusals=()):
    path.parent.mkdir(parents=True, exist_ok=True)
    halves = [half for one in made for half in one["halves"]]
    with h5py.File(path, "w") as file:
        file["particles/id"] = ids
        file["particles/status"] = np.isin(ids, [one["parent"] for one in made]).astype(np.int32) * 3
        file["particles/failure_mode"] = np.zeros(len(ids), dtype=np.int32)
        file["particles/mean_stress"] = 1e6 * np.random.default_rng(k).uniform(-1, 5, (len(ids), 3))
        file["broken/parent"] = np.array([one["parent"] for one in made], dtype=np.int64)
        file["broken/path"] = np.array([one["path"] for one in made]).reshape(-1, 2, 2)
        file["fragments/id"] = np.array([i for one in made for i in one["id"]], dtype=np.int64)
        file["fragments/parent"] = np.repeat(np.array([one["parent"] for one in made], dtype=np.int64), 2)
        file["fragments/vertex_offset"] = np.cumsum([0] + [len(half) for half in halves])
        file["fragments/vertices"] = np.vstack(halves) if halves else np.zeros((0, 2))
        file["refusals/particle"] = np.array([particle for particle, _ in refusals], dtype=np.int64)
        file.create_dataset("refusals/reason", data=[reason for _, reason in refusals], shape=(len(refusals),),
                            dtype=h5py.string_dtype())
        file.attrs.update({"schema": "split/1", "frame": k, "frame_hash": frame_hash, "config_hash": "d" * 32})
    return seal(path)


def write_run(directory, frames=21, strain=0.10, breakable=True, size=(8, 6), breaks=lambda k: 1 if k % 2 else 0,
              anisotropy=(0.3, 0.5, 0.2), contacts=None, pressure=2e6):
    """A finished run: `frames` frames to `strain`; split k breaks `breaks(k)` particles; `contacts` in every frame,
    two for each particle if not told."""
    directory.mkdir(parents=True, exist_ok=True)
    case = json.loads(json.dumps(CASE))
    case["shear"]["axial_strain"] = strain
    case["preparation"]["confining_pressure"] = pressure
    if not breakable:
        case["effects"].remove("breakage")
    (directory / "case.yaml").write_text(yaml.safe_dump(case, sort_keys=False))
    assembly = Assembly(*size)
    rows = 50
    events = [{"event": "start", "time": 0.0}]
    for k in range(frames):
        end = strain * k / (frames - 1)
        span = strain / (frames - 1)
        strains = np.zeros(1) if k == 0 else end - span + span * (np.arange(rows) + 1) / rows
        state = contacts_of_known_anisotropy(contacts or 2 * len(assembly.id),
                                             *(value * min(1.0, end / 0.04) for value in anisotropy))
        history = history_rows(max(0, (k - 1) * rows + 1), strains, pressure, len(assembly.id), 2 * len(assembly.id))
        frame_hash = write_frame(directory / "frames" / f"{k:06d}.h5", assembly, k, end, k == frames - 1, state,
                                 history, step=k * rows)
        events.append({"event": "frame", "frame": k, "time": float(k), "seconds": {"dem": 1.0}})
        if breakable:
            ids = assembly.id.copy()
            inside = np.flatnonzero((assembly.boundary == 0) & (assembly.parent < 0))
            made = [assembly.break_one(int(np.flatnonzero(assembly.id == particle)[0]))
                    for particle in assembly.id[inside[:breaks(k)]]]
            write_split(directory / "splits" / f"{k:06d}.h5", k, frame_hash, ids, made)
            events.append({"event": "split", "frame": k, "time": k + 0.5, "broken": len(made),
                           "seconds": {"xfem": 0.5, "handover": 0.01}})
    events.append({"event": "warning", "time": 1.0, "source": "dem", "text": "the servo <saturated> once"})
    events.append({"event": "end", "time": 30.0, "code": 0})
    (directory / "run.jsonl").write_text("".join(json.dumps(event) + "\n" for event in events))
    return directory
