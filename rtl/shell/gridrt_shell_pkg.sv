// Types that the shell's blocks share.
package gridrt_shell_pkg;

  /* verilator lint_off UNUSEDPARAM */
  // Yosys lets no package use another one's constants: these equal those of gridrt_protocol_pkg.
  localparam logic [31:0] CRC_START = 32'hFFFFFFFF;
  // What the register holds behind bytes that their own CRC-32C follows.
  localparam logic [31:0] CRC_RESIDUE = 32'hB798B438;

  localparam logic [1:0] ANSWER_NO_OP = 2'd0;
  localparam logic [1:0] ANSWER_ERROR = 2'd1;
  localparam logic [1:0] ANSWER_HITS = 2'd2;

  localparam int unsigned COUNT_W = 18;  // rays of one frame
  localparam int unsigned ANSWER_W = 2 + 3 * 32;
  localparam int unsigned VERDICT_W = 1 + COUNT_W;
  localparam int unsigned REFUSAL_W = 16 + 32;
  localparam int unsigned SAVED_W = 4 + 1 + 3 + 14 + 16 + 32 + 48;
  /* verilator lint_on UNUSEDPARAM */

  // Code and detail as the protocol has them; code 0: no objection.
  typedef struct packed {
    logic [15:0] code;
    logic [31:0] detail;
  } refusal_t;

  // One frame to be sent. Error: code and detail; hits: count and tag.
  typedef struct packed {
    logic [1:0]  kind;
    logic [31:0] sequence_;
    logic [31:0] first;
    logic [31:0] second;
  } answer_t;

  // How a Trace has ended: its hits frame is completed accordingly.
  typedef struct packed {
    logic               bad;  // the frame's CRC must not match
    logic [COUNT_W-1:0] missing;  // rays that never reached the engine
  } verdict_t;

  // How far a section of an image has been loaded. A frame that turns out bad leaves it untouched.
  typedef struct packed {
    logic [3:0]  over;  // cells: an owner's references do not reach that far
    logic        bad;  // a record that points outside another section
    logic [2:0]  phase;  // bytes of the record at hand
    logic [13:0] index;  // whole records
    logic [15:0] progress;  // bytes
    logic [31:0] crc;
    logic [47:0] part;  // the record's bytes so far, the last one on top
  } saved_t;

  // What a valid image header says, as far as a device needs it.
  typedef struct packed {
    logic [2:0]       pes;  // 1 .. 4
    logic [2:0][16:0] box;  // largest coordinate of a ray
    logic [2:0][16:0] max_q;  // largest coordinate of a vertex
    logic [2:0][9:0]  count;  // voxels
    logic [2:0][17:0] edges;  // lattice steps of a voxel
    logic [19:0]      local_ids;
    logic [13:0]      cells;
  } header_t;

endpackage
