#include "host/app/exit_code.hpp"
#include "host/app/image_program.hpp"

int main(int argc, char** argv) {
  return gridrt::run_program("gridrt-image", gridrt::run_image, argc, argv);
}
