"""How a call runs: Ctrl-C, progress, other threads, deadlines."""

import os
import signal
import threading
import time

import bccskel
import harness
import numpy

from shapes import ball

# Seconds of work on one thread.
LARGE = ball(200)


class JobsTest(harness.TestCase):
    def test_ctrl_c_ends_the_work(self):
        totals = {}

        def interrupt():
            while not totals:
                time.sleep(0.001)
            os.kill(os.getpid(), signal.SIGINT)

        killer = threading.Thread(target=interrupt)
        killer.start()
        with self.assertRaises(KeyboardInterrupt):
            # Python takes signals in functions of its own, but not in this one.
            bccskel.skeletonize(LARGE, threads=1, progress=totals.__setitem__)
        killer.join()
        self.assertLess(max(totals), totals[max(totals)])

    def test_what_progress_raises_ends_the_work(self):
        reports = []

        def stop(done, total):
            reports.append((done, total))
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            bccskel.skeletonize(LARGE, threads=1, progress=stop)
        self.assertEqual(len(reports), 1)
        self.assertLess(*reports[0])

    def test_progress_ends_with_all(self):
        reports = []
        image = numpy.kron(numpy.arange(6).reshape(1, 2, 3), numpy.ones((8, 8, 8), int))
        bccskel.skeletonize_labels(image, progress=lambda *report: reports.append(report))
        self.assertEqual(reports[-1], (5, 5))
        bccskel.skeletonize(ball(10), progress=lambda *report: reports.append(report))
        self.assertEqual(*reports[-1])

    def test_other_threads_go_on(self):
        rounds, ended = [], threading.Event()

        def turn():
            while not ended.is_set():
                rounds.append(len(rounds))
                time.sleep(0.001)

        thread = threading.Thread(target=turn)
        thread.start()
        before = len(rounds)
        bccskel.skeletonize(LARGE, threads=1)
        during = len(rounds) - before
        ended.set()
        thread.join()
        self.assertGreater(during, 20)

    def test_calls_run_beside_each_other(self):
        results = []
        threads = [threading.Thread(target=lambda: results.append(
            bccskel.skeletonize(ball(12), threads=n).sha256)) for n in (0, 1, 3, 4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(results, [bccskel.skeletonize(ball(12)).sha256] * 4)

    def test_a_deadline_passes(self):
        with self.assertRaises(TimeoutError):
            bccskel.skeletonize(LARGE, threads=1, timeout=0.002)


if __name__ == "__main__":
    harness.main()
