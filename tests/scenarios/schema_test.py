"""Editors check scenarios by scenarios/scenario.schema.json: it takes all that ship and no wrong ones."""

import json
import pathlib
import sys

try:
    import jsonschema
    import yaml
except ImportError as error:
    print(f"SKIPPED: {error} (Debian: python3-jsonschema, python3-yaml)")
    sys.exit(77)

folder = pathlib.Path(sys.argv[1])
schema = json.loads((folder / "scenario.schema.json").read_text())
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)

files = list(folder.rglob("*.yaml"))
assert len(files) > 50, files
for file in files:
    for error in validator.iter_errors(yaml.safe_load(file.read_text())):
        sys.exit(f"{file}: {error.message} at {list(error.absolute_path)}")

RIGHT = [
    "{scene: lab, frames: 3, ego: {}}",
    "{scene: lab, duration: 200 ms, ego: {waypoints: [[0, 1 m, 2], [1 s, 2, 2]]}}",
    "{recording: {path: a.mp4}}",
    "{recording: {path: a.mp4, distortion: [0, 0, 0, 0, 0]}, frames: 5, corners: {threshold: auto}}",
    "{scene: lab, frames: 3, ego: {acceleration: -5 cm/s^2}, image: {noise: none, gain: '2'}}",
    "{scene: lab, frames: 3, ego: {path: [[0, 0, 0, 1, 0, 9 deg, 0], [1 s, 1, 0, 1, 0, 0, 0]]}}",
    "{scene: lab, frames: 3, ego: {}, camera: {focal: [500 px, 499], distortion: [0, 0, 0, 0, 0]}}",
    "{scene: lab, frames: 3, ego: {}, cameras: {left: {}, right: {fovy: 50 deg}}, filter_camera: right}",
]
WRONG = [
    "{frames: 3, ego: {}}",  # no scene
    "{scene: lab, frames: 3}",  # no ego
    "{scene: lab, ego: {}}",  # no length
    "{scene: lab, frames: 3, duration: 1 s, ego: {}}",
    "{scene: lab, recording: {path: a.mp4}, frames: 3, ego: {}}",
    "{recording: {path: a.mp4}, ego: {}}",
    "{recording: {path: a.mp4, poses: a.txt, speed: 1 m/s}}",
    "{recording: {}}",
    "{scene: lab, frames: 3, ego: {}, sede: 4}",
    "{scene: lab, frames: 3, ego: {sped: 4}}",
    "{scene: lab, frames: 3, ego: {speed: 9 deg}}",
    "{scene: lab, frames: 3, ego: {speed: -1}}",
    "{scene: lab, frames: 3, ego: {speed: -1 m/s}}",
    "{scene: lab, frames: 3, ego: {speed: 101}}",
    "{scene: lab, frames: 3, ego: {start: [1 m]}}",
    "{scene: lab, frames: 3, ego: {speed: 1, waypoints: [[0, 1, 2], [1, 2, 2]]}}",
    "{scene: lab, frames: 3, ego: {speed: 1, path: [[0, 0, 0, 1, 0, 0, 0], [1, 1, 0, 1, 0, 0, 0]]}}",
    "{scene: lab, frames: 3, ego: {path: [[0, 0, 0, 1], [1, 1, 0, 1]]}}",
    "{scene: lab, frames: 3, ego: {}, camera: {focal: [500, 499, 498]}}",
    "{scene: lab, frames: 0, ego: {}}",
    "{scene: lab, frames: 3, ego: {}, camera: {fovy: 60 deg, focal: 600 px}}",
    "{scene: lab, frames: 3, ego: {}, camera: {fovy: 0}}",
    "{scene: lab, frames: 3, ego: {}, camera: {}, cameras: {left: {}, right: {}}}",
    "{scene: lab, frames: 3, ego: {}, cameras: {}}",
    "{scene: lab, frames: 3, ego: {}, cameras: {left: {fovi: 50 deg}}}",
    "{scene: lab, frames: 3, ego: {}, imu: {preset: mpu6050}}",
    "{scene: lab, frames: 3, ego: {}, groups: [a, a]}",
    "{scene: lab, frames: 3, ego: {}, actors: {a: {shape: ball, trajectory: {still: {}}}}}",
    "{scene: lab, frames: 3, ego: {}, actors: {a: {shape: box}}}",
    "{scene: lab, frames: 3, ego: {}, actors: {a: {shape: box, body: b, trajectory: {still: {}}}}}",
    "{scene: lab, frames: 3, ego: {}, actors: {ego: {shape: box, trajectory: {still: {}}}}}",
    "{scene: lab, frames: 3, ego: {}, actors: {a: {body: b, trajectory: {still: {}, line: {speed: 1}}}}}",
    "{scene: lab, frames: 3, ego: {}, criteria: [{min: 1}]}",
]
for text in RIGHT:
    validator.validate(yaml.safe_load(text))
for text in WRONG:
    if validator.is_valid(yaml.safe_load(text)):
        sys.exit(f"the schema takes {text}")
