#include "host/app/exit_code.hpp"
#include "host/app/image_program.hpp"
#include "host/grid/patient_threads.hpp"

int main(int argc, char** argv) {
  gridrt::wait_patiently(argv);
  return gridrt::run_program("gridrt-image", gridrt::run_image, argc, argv);
}
