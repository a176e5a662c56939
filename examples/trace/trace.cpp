// Traces two rays through a scene made in memory and prints what they hit.
#include <cstdio>

#include <gridrt.hpp>

int main() {
  gridrt::Scene scene;  // a unit square in the plane z = 0, of two triangles
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  auto tracer = gridrt::Tracer::open(scene, {.name = "omp"});
  if (!tracer) return std::fprintf(stderr, "%s\n", tracer.error().message.c_str()), 1;
  const gridrt::Ray rays[] = {{{0.75, 0.25, 2.0}, {0, 0, -1}}, {{1.5, 0.5, 2.0}, {0, 0, -1}}};
  const auto hits = tracer->trace(rays);
  if (!hits) return std::fprintf(stderr, "%s\n", hits.error().message.c_str()), 1;
  for (const gridrt::Hit& hit : *hits) std::printf("triangle %d at t = %g\n", hit.id, hit.t);
}
