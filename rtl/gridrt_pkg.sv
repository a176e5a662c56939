// Types and widths that the engine's blocks share. Widths that depend on the lattice bits B are
// parameters of the modules; what is here holds for every configuration.
package gridrt_pkg;

  // A design uses the constants that it needs.
  /* verilator lint_off UNUSEDPARAM */
  localparam int unsigned MAX_B = 17;  // lattice bits of a coordinate in a ray record
  localparam int unsigned MAX_PES = 4;
  localparam int unsigned PE_W = 2;  // number of a PE
  localparam int unsigned SLOT_W = 6;  // number of a ray slot, at most 64 slots
  localparam int unsigned DIST_W = 18;  // distance from P0 along the dominant axis, lattice steps
  localparam int unsigned KEY_BITS = 24;  // quotient = floor(2^24 tn / det)
  localparam int unsigned Q_W = 25;  // a quotient, 0 .. 2^24
  localparam int unsigned ID_W = 20;  // local triangle id; all ones: none
  localparam int unsigned REF_W = 14;  // index of a reference in its PE's memory
  localparam int unsigned LIST_W = 10;  // references of one voxel
  localparam int unsigned TRI_W = 12;  // index of a triangle in its PE's memory
  localparam int unsigned VERT_W = 12;  // index of a vertex in its PE's memory
  localparam int unsigned CELL_W = 13;  // index of a cell record
  localparam int unsigned BLOCK_W = 12;  // index of a 2x2x2 block
  localparam int unsigned AXIS_W = 10;  // voxels along an axis, 1 .. 512
  localparam int unsigned FRACTION = 13;  // bits behind the point of a lateral position
  localparam logic [ID_W-1:0] NO_ID = '1;
  // Registers of a pipeline that nothing holds up take what is there in every clock: clock enables would
  // cost an ECP5 a tenth of its wires. In simulation, which is faster so, they move for what is valid.
`ifdef GRIDRT_FREE_RUNNING
  localparam bit FREE_RUNNING = 1'b1;
`else
  localparam bit FREE_RUNNING = 1'b0;
`endif
  // Widths of the structs below, for arrays of them: yosys takes neither $bits of a type in a
  // package nor fields of an array's element.
  localparam int unsigned CELLS_W = 2 + 2 * 4 * 4;
  localparam int unsigned TASK_W = SLOT_W + REF_W + LIST_W + CELLS_W + DIST_W;
  localparam int unsigned EVENT_W = SLOT_W + 2 + Q_W + ID_W + DIST_W;
  localparam int unsigned WAY_W = 2 + 8 + 2 * 9 * 4;
  localparam int unsigned BUNDLE_W = SLOT_W + CELL_W + 3 * 8 + WAY_W + 2 * DIST_W;
  localparam int unsigned INTERRUPT_W = 1 + SLOT_W + DIST_W;
  localparam int unsigned SLOT_EVENT_W = 1 + SLOT_W;
  /* verilator lint_on UNUSEDPARAM */

  // A voxel to be tested for a ray: references [first, first + count) of the PE's memory.
  typedef struct packed {
    logic [SLOT_W-1:0] slot;
    logic [REF_W-1:0]  first;
    logic [LIST_W-1:0] count;  // >= 1
    // The dominant axis a; then, for the quarter-slabs of a from the last to the first, the quarters of
    // b = a + 1 (modulo 3) in which the ray is within each, none where it is not; and those of c = a + 2.
    // Within a quarter-slab it meets every quarter of b together with every one of c, a superset of the
    // truth. Not mirrored.
    logic [CELLS_W-1:0] cells;
    logic [DIST_W-1:0] enter;  // where the ray enters the voxel's slab
  } task_t;

  // What a PE has found, in the order of its tests.
  typedef struct packed {
    logic [SLOT_W-1:0] slot;
    logic              last;  // the task of this slot is complete with this event
    logic              hit;  // quotient, id and limit hold a hit
    logic [Q_W-1:0]    quotient;  // 0 for any-hit rays
    logic [ID_W-1:0]   id;  // 0 for any-hit rays
    logic [DIST_W-1:0] limit;  // slabs entered beyond it hold no smaller key
  } event_t;

  // A ray's way through a block: the eight quarter-slabs of the dominant axis a that it is in, and where
  // it is on the other axes b = a + 1, c = a + 2 (modulo 3) at their nine faces: a quarter of the block's
  // two voxels, 0 to 7, or outside of the block (8 and more). It never moves by more than a quarter from
  // one face to the next. Not mirrored.
  typedef struct packed {
    logic [1:0]           axis;
    logic [7:0]           holds;  // by quarter-slab
    logic [1:0][8:0][3:0] samples;  // b, c; by face
  } way_t;

  // The voxels of one 2x2x2 block that a ray meets, from a traversal unit to an expander. A voxel is
  // a bit of the block, x + 2 y + 4 z in the grid's own (not mirrored) axes. Voxels of the near slab
  // come before those of the far one; within a slab any order is right.
  typedef struct packed {
    logic [SLOT_W-1:0] slot;
    logic [CELL_W-1:0] base;  // cell record of the block's first occupied voxel
    logic [7:0] occ;  // occupied voxels: the record of voxel v is base + popcount(occ below bit v)
    logic [7:0] cand;  // voxels to test: met by the ray and occupied, a part of occ, not empty
    logic [7:0] front;  // voxels in the slab (of the dominant axis) that the ray enters first
    logic [WAY_W-1:0] way;  // through the block: way_t
    logic [DIST_W-1:0] near_enter;  // where the ray enters the near slab, 0 if it starts in it
    logic [DIST_W-1:0] far_enter;  // where it enters the far slab
  } bundle_t;

  // A hit lowers the limit of a ray: whatever is entered beyond it is cancelled.
  typedef struct packed {
    logic              valid;
    logic [SLOT_W-1:0] slot;
    logic [DIST_W-1:0] limit;
  } interrupt_t;

  // A ray has been given a slot.
  typedef struct packed {
    logic              valid;
    logic [SLOT_W-1:0] slot;
  } slot_event_t;

  // One record of an image on its way to the memories (kind: section_kind_e of the protocol).
  typedef struct packed {
    logic        valid;
    logic [7:0]  kind;
    logic [1:0]  pe;
    logic [13:0] index;
    logic [55:0] data;  // the record, from bit 0 up
  } load_t;

  // What the engine counts; each field is added to a total every clock.
  typedef struct packed {
    logic       ray;  // a ray has been committed
    logic [2:0] steps;  // traversal steps
    logic [2:0] tests;  // exact tests
    logic [5:0] masked;  // references left out by their quarters
    logic [2:0] interrupts;  // tasks and voxels cancelled by an earlier hit
    logic       feedback_wait;  // a hit that waited for earlier voxels has been committed
    logic       in_flight;  // at least one ray is in the engine
    // Where clocks went, while in_flight:
    logic       no_ray;  // a ray could have been taken and none was offered
    logic       no_slot;  // a ray waits for a slot
    logic [2:0] traversal_idle;  // traversal units whose rays all have enough tasks ahead
    logic [2:0] queue_full;  // PEs whose full queue a task waits for
    logic [2:0] pe_idle;  // PEs without work
    logic [2:0] divider_busy;  // PEs with a hit that waits for a divider
    logic       hit_wait;  // a hit waits to be taken
  } counts_t;

  // The life of a ray, for the event log; meant for one single ray in flight.
  typedef struct packed {
    logic              step_valid;  // a traversal step
    logic [BLOCK_W-1:0] step_block;
    logic [7:0]        step_cand;  // voxels of the block that become tasks, in the grid's own axes
    logic [7:0]        step_jump;  // blocks moved ahead, 0: the next step stays in this slab
    logic              task_valid;  // a task leaves an expander
    logic [PE_W-1:0]   task_pe;
    logic [REF_W-1:0]  task_first;
    logic [LIST_W-1:0] task_count;
    logic [7:0]        task_octants;
    logic [DIST_W-1:0] task_enter;
    logic              expand_drop;  // a voxel is cancelled before it becomes a task
    logic [3:0]        test_valid;  // per PE: an exact test ends
    logic [3:0][TRI_W-1:0] test_triangle;  // index in the PE's memory
    logic [3:0]        test_hit;
    logic [3:0]        drop_valid;  // per PE: a task ends without an event
    logic [3:0]        drop_cancelled;  // because of an earlier hit, not of the mask
    logic              hit_valid;  // feedback takes a hit event
    logic [Q_W-1:0]    hit_quotient;
    logic [ID_W-1:0]   hit_id;
    logic              interrupt_valid;  // the limit of the ray falls
    logic [DIST_W-1:0] interrupt_limit;
    logic              commit_valid;  // the answer
    logic              commit_hit;
    logic [ID_W-1:0]   commit_id;
  } tap_t;

endpackage
