#!/usr/bin/python3
"""The steps of vizard_test.py, by Basilisk's own vizInterface.

    HILCAM_BASILISK=CHECKOUT basilisk_test.py HILCAM

CHECKOUT is one of Basilisk's sources (AVSLab/basilisk, 2.1.5 or later); nothing of it but vizInterface and what it needs is compiled,
with g++, protoc, and the headers of Eigen (libeigen3-dev), ZeroMQ and protobuf. Without a checkout the test is skipped.
"""
import functools
import os
import sys
import tempfile
import unittest

if __name__ == "__main__":
    if not os.environ.get("HILCAM_BASILISK"):
        print("skipped: HILCAM_BASILISK names no checkout of Basilisk")
        sys.exit(77)
    import basilisk_itself
    import vizard_test
    with tempfile.TemporaryDirectory() as folder:
        driver = basilisk_itself.build(os.environ["HILCAM_BASILISK"], folder)
        vizard_test.Vizard.client = functools.partial(basilisk_itself.VizInterface, driver)
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        suite = unittest.TestSuite([load(vizard_test.OpticalNavigation), load(vizard_test.Runs)])
        sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
