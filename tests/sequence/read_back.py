"""Reads a generated sequence with the tools that it is meant for.

Usage: read_back.py SEQUENCE RUN WORK EVENTS

RUN is a folder of lcs run of the same scenario, whose truth.jsonl has the boxes; WORK is for the files
that TrackEval wants; EVENTS is a sequence of an event camera.
"""
import configparser
import csv
import json
import pathlib
import shutil
import sys

import numpy as np


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")
    print(f"fine: {what}")


def read_trajectories(sequence):
    from evo.core import metrics, sync
    from evo.tools import file_interface

    euroc = file_interface.read_euroc_csv_trajectory(
        sequence / "mav0/state_groundtruth_estimate0/data.csv")
    imu = file_interface.read_tum_trajectory_file(sequence / "tum/imu.txt")
    camera = file_interface.read_tum_trajectory_file(sequence / "tum/camera.txt")
    check(euroc.check()[0] and imu.check()[0] and camera.check()[0],
          "evo: trajectories are valid (unit quaternions, times that rise)")
    check(np.array_equal(euroc.positions_xyz, imu.positions_xyz), "evo: EuRoC's and TUM's positions are equal")
    a, b = sync.associate_trajectories(euroc, imu)
    error = metrics.APE(metrics.PoseRelation.full_transformation)
    error.process_data((a, b))
    check(a.num_poses == euroc.num_poses and error.get_statistic(metrics.StatisticsType.max) < 1e-9,
          "evo: the error of one by the other is 0")
    rows = list(csv.reader(open(sequence / "mav0/cam0/pose.csv")))[1:]
    T = np.array([[float(x) for x in row[1:]] for row in rows]).reshape(-1, 3, 4)
    own = np.array(camera.poses_se3)[:, :3, :]
    check(np.abs(T - own).max() < 1e-12, "evo: camera poses are those of pose.csv, axes and signs included")


def read_boxes(sequence, run):
    from pycocotools import mask
    from pycocotools.coco import COCO
    from pycocotools.cocoeval import COCOeval

    coco = COCO(str(sequence / "coco/annotations.json"))
    truth = [json.loads(line) for line in open(run / "truth.jsonl")][1:]
    seen = 0
    for image in coco.getImgIds():
        objects = truth[image - 1]["objects"]
        annotations = {a["track_id"]: a for a in coco.loadAnns(coco.getAnnIds(imgIds=image))}
        check_ids = sorted(annotations) == sorted(objects["object"])
        if not check_ids:
            check(False, f"pycocotools: objects of image {image}")
        for i, track in enumerate(objects["object"]):
            a = annotations[track]
            pixels = coco.annToMask(a)
            x, y, width, height = mask.toBbox(coco.annToRLE(a))
            box = [objects["left"][i], objects["top"][i], objects["right"][i] - objects["left"][i],
                   objects["bottom"][i] - objects["top"][i]]
            if list((x, y, width, height)) != box or a["bbox"] != box or pixels.sum() != objects["visible_px"][i]:
                check(False, f"pycocotools: mask and box of object {track} in image {image}")
            seen += 1
    check(seen > 0, f"pycocotools: {seen} masks have the boxes and areas of the truth")
    results = [{"image_id": a["image_id"], "category_id": a["category_id"], "bbox": a["bbox"], "score": 1.0}
               for a in coco.dataset["annotations"]]
    evaluation = COCOeval(coco, coco.loadRes(results), "bbox")
    evaluation.evaluate()
    evaluation.accumulate()
    evaluation.summarize()
    check(abs(evaluation.stats[0] - 1) < 1e-9, "pycocotools: the truth, taken as a detector's result, has AP 1")


def read_masks(sequence, run):
    from PIL import Image

    truth = [json.loads(line) for line in open(run / "truth.jsonl")][1:]
    name = next((sequence / "davis/Annotations/480p").iterdir())
    for k, path in enumerate(sorted(name.iterdir())):
        picture = Image.open(path)
        if picture.mode != "P":
            check(False, "Pillow: masks are indexed")
        ids = np.asarray(picture)
        objects = truth[k]["objects"]
        counts = {int(i): int((ids == i).sum()) for i in np.unique(ids) if i not in (0, 254)}
        if counts != dict(zip(objects["object"], objects["visible_px"])):
            check(False, f"Pillow: objects of mask {k}")
    check(True, "Pillow: DAVIS's masks are indexed and have every object with all of its pixels")


def read_tracks(sequence, work):
    import trackeval

    source = next((sequence / "mot").iterdir())
    gt, trackers = work / "gt" / source.name, work / "trackers" / "same" / "data"
    (gt / "gt").mkdir(parents=True)
    trackers.mkdir(parents=True)
    shutil.copy(source / "seqinfo.ini", gt / "seqinfo.ini")
    shutil.copy(source / "gt/gt.txt", gt / "gt/gt.txt")
    info = configparser.ConfigParser()
    info.read(source / "seqinfo.ini")
    length = int(info["Sequence"]["seqLength"])
    check(len(list((source / "img1").iterdir())) == length, "MOTChallenge: a picture for each frame")
    with open(trackers / f"{source.name}.txt", "w") as out:
        for row in csv.reader(open(source / "gt/gt.txt")):
            if row[6] == "1":
                print(*row[:6], 1, -1, -1, -1, sep=",", file=out)
    evaluator = trackeval.Evaluator({"USE_PARALLEL": False, "PRINT_CONFIG": False, "PLOT_CURVES": False,
                                     "BREAK_ON_ERROR": True, "TIME_PROGRESS": False})
    dataset = trackeval.datasets.MotChallenge2DBox({
        "GT_FOLDER": str(work / "gt"), "TRACKERS_FOLDER": str(work / "trackers"), "SKIP_SPLIT_FOL": True,
        "DO_PREPROC": False, "SEQ_INFO": {source.name: length}, "PRINT_CONFIG": False,
        "OUTPUT_FOLDER": str(work / "out")})
    result, _ = evaluator.evaluate([dataset], [trackeval.metrics.HOTA(), trackeval.metrics.CLEAR()])
    scores = result["MotChallenge2DBox"]["same"]["COMBINED_SEQ"]["pedestrian"]
    check(np.allclose(scores["HOTA"]["HOTA"], 1) and scores["CLEAR"]["MOTA"] == 1 and scores["CLEAR"]["CLR_TP"] > 0,
          "TrackEval: the truth, taken as a tracker's output, has HOTA 1 and MOTA 1")


def read_calibration(sequence):
    import yaml

    camera = yaml.safe_load(open(sequence / "mav0/cam0/sensor.yaml"))
    imu = yaml.safe_load(open(sequence / "mav0/imu0/sensor.yaml"))
    own = json.load(open(sequence / "lcs.json"))
    check(camera["intrinsics"][0] == own["camera"]["focal_px"] and camera["resolution"] == [640, 480]
          and camera["camera_model"] == "pinhole", "PyYAML: the camera's sensor.yaml")
    T = [np.array(s["T_BS"]["data"]).reshape(s["T_BS"]["rows"], s["T_BS"]["cols"]) for s in (camera, imu)]
    own_T = np.linalg.inv(np.array(own["T_BS"]).reshape(4, 4)) @ np.array(own["T_BC"]).reshape(4, 4)
    check(np.abs(T[0] - own_T).max() < 1e-12 and np.array_equal(T[1], np.eye(4)),
          "PyYAML: T_BS of the camera is its pose in the IMU, that of the IMU the identity")
    check(all(isinstance(imu[key], float) and imu[key] > 0 for key in (
        "gyroscope_noise_density", "gyroscope_random_walk", "accelerometer_noise_density",
        "accelerometer_random_walk")), "PyYAML: Kalibr's four noise figures are numbers")


def read_events(sequence):
    import evlib

    text, hdf5 = (evlib.load_events(str(sequence / name)).collect() for name in ("rpg/events.txt", "dsec/events.h5"))
    count = sum(1 for _ in open(sequence / "rpg/events.txt"))
    check(len(text) == len(hdf5) == count > 1000, "evlib: RPG's text and DSEC's HDF5 have all events")
    check(text["x"].equals(hdf5["x"]) and text["y"].equals(hdf5["y"]), "evlib: both have them at the same pixels")
    check((text["polarity"] > 0).equals(hdf5["polarity"] > 0), "evlib: both have them of the same polarity")
    # evlib counts the times of HDF5 from the file's first millisecond
    apart = (text["t"] - text["t"][0]) - (hdf5["t"] - hdf5["t"][0])
    check(apart.dt.total_microseconds().abs().max() <= 1, "evlib: both have them at the same microsecond")


def main():
    sequence, run, work, events = map(pathlib.Path, sys.argv[1:])
    read_trajectories(sequence)
    read_boxes(sequence, run)
    read_masks(sequence, run)
    read_tracks(sequence, work)
    read_calibration(sequence)
    read_events(events)


main()
