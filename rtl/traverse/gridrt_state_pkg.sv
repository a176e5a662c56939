// What ray setup hands to a traversal unit, and the constants of a grid that both need. Coordinates
// are mirrored (p~ = span - p on axes with a negative direction), so that every ray travels upwards.
// Widths are those of 17 lattice bits; with fewer the upper bits are 0.
package gridrt_state_pkg;

  // Yosys lets no package use another one's constants: these equal those of gridrt_pkg, which
  // gridrt_setup checks.
  /* verilator lint_off UNUSEDPARAM */
  localparam int unsigned AXIS_W = 10;
  localparam int unsigned BLOCK_W = 12;
  localparam int unsigned DIST_W = 18;
  localparam int unsigned EDGE_W = 18;  // a voxel's edge, up to 2^17
  localparam int unsigned SPAN_W = 19;
  localparam int unsigned SLABS_W = 8;  // block-slabs after the first one
  // A quarter-voxel is edge * 2^UNIT_SHIFT units of a lateral position, a unit 2^-FRACTION steps.
  localparam int unsigned UNIT_SHIFT = 11;
  localparam int unsigned REST_W = 28;  // within a quarter-voxel
  localparam int unsigned START_W = 200;  // of start_t, for registers
  localparam int unsigned KEPT_W = 2 + 3 + 3 + 2 * (REST_W + 1);  // of what a ray keeps: axis, neg, last, slope
  /* verilator lint_on UNUSEDPARAM */

  // Per axis x, y, z.
  typedef struct packed {
    logic [2:0][EDGE_W-1:0] edges;  // lattice steps of a voxel
    logic [2:0][SPAN_W-1:0] span;  // lattice steps of all blocks, 2 half_blocks edge
    logic [2:0][AXIS_W-1:0] half_blocks;  // blocks of 2x2x2 voxels
    logic [2:0][BLOCK_W-1:0] stride;  // a block's address is x + y stride_y + z stride_z
  } grid_t;

  // Where a ray is. A block-slab is the layer of blocks (two voxels) along the dominant axis that
  // holds the position; the block is the one in which the ray enters it.
  typedef struct packed {
    logic [1:0] axis;  // dominant: the one along which the ray crosses most voxels
    logic [2:0] neg;  // axes with a negative direction
    logic [BLOCK_W-1:0] block;  // address of the block
    logic [SLABS_W-1:0] slabs;  // block-slabs after this one
    logic [2:0] first;  // first quarter-slab of this block-slab that holds a part of the segment
    logic [2:0] last;  // last one, in the last block-slab
    logic signed [DIST_W:0] enter;  // the block-slab's entry face - P0, lattice steps
    // Lateral axes: [0] is axis + 1, [1] is axis + 2, modulo 3.
    logic [1:0][3:0] quarter;  // at the entry, from the block's first one: signed, -8 .. 7
    logic [1:0][2:0] low;  // no sample lies below this quarter: P0's in the first block, then 0
    logic [1:0][REST_W-1:0] rest;  // position within that quarter, below edge * 2^UNIT_SHIFT
    logic [1:0][REST_W:0] slope;  // increment per quarter-slab, at most edge * 2^UNIT_SHIFT
    logic [1:0][AXIS_W:0] limit;  // quarter of P1, from the block's first one
  } start_t;

endpackage
