"""What docker/ sets up is what the server takes and tells."""

import json
import re
import unittest

import yaml

from server_process import SOURCE, run_to_end

DOCKER = SOURCE / "docker"


def entry_point():
    """The flags that the image gives in any case."""
    line = re.search(r"^ENTRYPOINT (\[.*\])$", (DOCKER / "Dockerfile").read_text(), re.MULTILINE)
    return json.loads(line[1])[1:]


def server_arguments():
    """The server's flags, by the file that gives them."""
    image = entry_point()
    yield "Dockerfile", image
    compose = yaml.safe_load((DOCKER / "compose.yaml").read_text())
    yield "compose.yaml", image + compose["services"]["server"]["command"]
    fleet = yaml.safe_load((DOCKER / "compose-fleet.yaml").read_text())
    for name, service in fleet["services"].items():
        if name.startswith("server"):
            yield f"compose-fleet.yaml {name}", image + service["command"]
    for name in ("base/deployment.yaml", "durable/keep-jobs.yaml", "fleet/share-jobs.yaml"):
        deployment = yaml.safe_load((DOCKER / "kubernetes" / name).read_text())
        containers = deployment["spec"]["template"]["spec"]["containers"]
        yield name, image + next(c["args"] for c in containers if c["name"] == "server")
    unit = (DOCKER / "bccskel-server.service").read_text()
    yield "bccskel-server.service", re.search(r"^ExecStart=\S+ (.*)$", unit, re.MULTILINE)[1].split()


def named_metrics():
    """Names of metrics, by the file that reads them; of a histogram's series the histogram's."""
    for path in (DOCKER / "prometheus/alerts.yml", DOCKER / "grafana/bccskel.json",
                 DOCKER / "kubernetes/base/autoscaler.yaml",
                 DOCKER / "kubernetes/fleet/scale-by-queue.yaml"):
        for name in set(re.findall(r"\b(?:bccskel|process)_[a-z_]+\b", path.read_text())):
            yield path.name, re.sub(r"_bucket$", "", name)


class DeploymentTest(unittest.TestCase):
    def test_the_server_takes_the_flags_of_every_deployment(self):
        for name, arguments in server_arguments():
            with self.subTest(name):
                ended = run_to_end("--check-config", *arguments)
                self.assertEqual(ended.returncode, 0, ended.stderr)

    def test_the_image_is_asked_for_its_health_where_it_always_listens(self):
        text = (DOCKER / "Dockerfile").read_text()
        probe = json.loads(re.search(r"^HEALTHCHECK .*\n +CMD (\[.*\])$", text, re.MULTILINE)[1])
        self.assertEqual(probe[:3], ["bccskel", "probe", "--server"])
        self.assertEqual(entry_point(), ["--listen", probe[3]])
        for name, arguments in server_arguments():
            listened = [a for a in arguments if probe[3] in a]
            self.assertEqual(len(listened), 0 if name == "bccskel-server.service" else 1, name)

    def test_nginx_has_a_fixed_number_of_workers(self):
        text = (DOCKER / "nginx/nginx.conf").read_text()
        self.assertRegex(text, r"(?m)^worker_processes [1-4];$")

    def test_alerts_dashboard_and_autoscaler_read_metrics_that_there_are(self):
        sources = "".join(path.read_text() for path in (SOURCE / "server/metrics").glob("*.cc"))
        told = set(re.findall(r'"((?:bccskel|process)_[a-z_]+)"', sources))
        for name, metric in named_metrics():
            self.assertIn(metric, told, f"in {name}")

    def test_a_fleet_shares_a_folder_and_nginx_finds_every_server(self):
        fleet = yaml.safe_load((DOCKER / "compose-fleet.yaml").read_text())
        servers = {name: service for name, service in fleet["services"].items()
                   if name.startswith("server")}
        self.assertEqual(len(servers), 3)
        mounts = dict(mount.split(":")[:2] for mount in fleet["services"]["nginx"]["volumes"])
        upstreams = (DOCKER / "nginx/fleet/servers.conf").read_text()
        targets = yaml.safe_load((DOCKER / "prometheus/fleet.yml").read_text())[
            "scrape_configs"][0]["static_configs"][0]["targets"]
        for name, service in servers.items():
            volumes = dict(mount.split(":")[:2] for mount in service["volumes"])
            self.assertEqual(volumes["data"], "/var/lib/bccskel")
            socket = next(volume for volume, at in volumes.items() if at == "/run/bccskel")
            self.assertIn(f"unix:{mounts[socket]}/server.sock", upstreams)
            self.assertIn(f"{name}:9464", targets)
        claim = yaml.safe_load((DOCKER / "kubernetes/fleet/volume-claim.yaml").read_text())
        self.assertEqual(claim["spec"]["accessModes"], ["ReadWriteMany"])

    def test_a_fleet_grows_with_the_jobs_in_its_tables(self):
        """Every server tells their number: an average over pods would count them once a pod."""
        fleet = DOCKER / "kubernetes/fleet"
        patches = yaml.safe_load((fleet / "kustomization.yaml").read_text())["patches"]
        scalers = [document for document in map(yaml.safe_load, (
            (fleet / patch["path"]).read_text() for patch in patches))
            if document["kind"] == "HorizontalPodAutoscaler"]
        self.assertEqual(len(scalers), 1)
        by_type = {metric["type"]: metric[metric["type"].lower()]
                   for metric in scalers[0]["spec"]["metrics"]}
        self.assertEqual(by_type["Pods"]["metric"]["name"], "bccskel_jobs_waiting")
        name = by_type["External"]["metric"]["name"]
        self.assertEqual(name, "bccskel_durable_jobs_queued")
        rule = re.search(r"```yaml\nexternalRules:.*?```", (DOCKER / "README.md").read_text(), re.S)
        self.assertIn(f"'{name}{{", rule[0])
        self.assertIn("'max(<<.Series>>", rule[0])

    def test_kustomizations_have_no_deprecated_fields(self):
        deprecated = {"bases", "commonLabels", "imageTags", "patchesJson6902",
                      "patchesStrategicMerge", "vars"}
        files = list((DOCKER / "kubernetes").glob("*/kustomization.yaml"))
        self.assertGreater(len(files), 2)
        for path in files:
            fields = set(yaml.safe_load(path.read_text()))
            self.assertEqual(fields & deprecated, set(), path)

    def test_both_kinds_of_pod_mount_what_nginx_and_server_share(self):
        base = yaml.safe_load((DOCKER / "kubernetes/base/deployment.yaml").read_text())
        for container in base["spec"]["template"]["spec"]["containers"]:
            mounts = {mount["name"]: mount["mountPath"] for mount in container["volumeMounts"]}
            self.assertEqual(mounts["socket"], "/run/bccskel")


if __name__ == "__main__":
    unittest.main()
