// The skip field. A block with references stores where its cells are, one without how far a ray
// may jump, so 22 bits do where the image has 39: {1, base, occupancy} or {0, jumps of six
// directions}. Each memory serves two traversal units.
module gridrt_blocks #(
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned TUS = 4,
    localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W,
    localparam int unsigned RECORD_W = 22
) (
    input  logic                                    clk_i,
    input  gridrt_pkg::load_t                       load_i,
    input  logic              [TUS-1:0]             enable_i,
    input  logic              [TUS-1:0][BLOCK_W-1:0] address_i,
    output logic              [TUS-1:0][RECORD_W-1:0] data_o  // two clocks after the address
);
  localparam int unsigned ADDRESS_W = (BLOCKS > 1) ? $clog2(BLOCKS) : 1;
  localparam int unsigned COPIES = (TUS + 1) / 2;
  localparam int unsigned LOW_W = 18;

  if (BLOCKS < 1 || BLOCKS > (1 << BLOCK_W)) begin : gen_illegal
    $error("gridrt_blocks: BLOCKS must be 1 to 4096");
  end

  gridrt_protocol_pkg::block_record_t record;
  logic [RECORD_W-1:0] kept;
  logic write;
  assign record = load_i.data[8*gridrt_protocol_pkg::BLOCK_RECORD_BYTES-1:0];
  assign write = load_i.valid && load_i.kind == gridrt_protocol_pkg::SECTION_KIND_BLOCKS;
  assign kept = (record.occupancy != '0) ? {1'b1, record.base, record.occupancy} :
                                           {4'd0, record.jump};

  for (genvar c = 0; c < COPIES; c++) begin : gen_copy
    logic b_enable;
    logic [ADDRESS_W-1:0] a_address, b_address;
    logic [RECORD_W-1:0] b_data;
    assign a_address = write ? ADDRESS_W'(load_i.index) : ADDRESS_W'(address_i[2*c]);
    if (2 * c + 1 < TUS) begin : gen_second
      assign b_enable = enable_i[2*c+1];
      assign b_address = ADDRESS_W'(address_i[2*c+1]);
      assign data_o[2*c+1] = b_data;
    end else begin : gen_none
      logic unused;
      assign b_enable = 1'b0;
      assign b_address = '0;
      assign unused = &{1'b0, b_data};
    end

    // 18 bits and 4: the shapes that leave nothing of a block memory unused.
    gridrt_ram_tdp #(
        .WIDTH(LOW_W),
        .DEPTH(BLOCKS),
        .BANK((BLOCKS > 2048) ? 2048 : BLOCKS),
        .OUTPUT_REGISTER(1'b1)
    ) u_low (
        .clk_i,
        .a_write_i(write),
        .a_enable_i(write || enable_i[2*c]),
        .a_address_i(a_address),
        .a_data_i(kept[LOW_W-1:0]),
        .a_data_o(data_o[2*c][LOW_W-1:0]),
        .b_enable_i(b_enable),
        .b_address_i(b_address),
        .b_data_o(b_data[LOW_W-1:0])
    );
    gridrt_ram_tdp #(
        .WIDTH(RECORD_W - LOW_W),
        .DEPTH(BLOCKS),
        .OUTPUT_REGISTER(1'b1)
    ) u_high (
        .clk_i,
        .a_write_i(write),
        .a_enable_i(write || enable_i[2*c]),
        .a_address_i(a_address),
        .a_data_i(kept[RECORD_W-1:LOW_W]),
        .a_data_o(data_o[2*c][RECORD_W-1:LOW_W]),
        .b_enable_i(b_enable),
        .b_address_i(b_address),
        .b_data_o(b_data[RECORD_W-1:LOW_W])
    );
  end

  logic unused_load;
  assign unused_load = &{1'b0, load_i, record.padding, address_i};
endmodule
