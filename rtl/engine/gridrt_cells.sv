// The cell records, {pe, count, first}: which references a voxel has and whose they are. 26 bits take
// three block memories of 9 bits for each 2,048 of them.
module gridrt_cells #(
    parameter int unsigned CELLS = 6144,
    parameter int unsigned EXPS  = 2,     // 1 or 2: the memory has two ports
    localparam int unsigned CELL_W = gridrt_pkg::CELL_W,
    localparam int unsigned RECORD_W = gridrt_pkg::REF_W + gridrt_pkg::LIST_W + gridrt_pkg::PE_W
) (
    input  logic                                   clk_i,
    input  gridrt_pkg::load_t                      load_i,
    input  logic              [EXPS-1:0]           enable_i,
    input  logic              [EXPS-1:0][CELL_W-1:0] address_i,
    output logic              [EXPS-1:0][RECORD_W-1:0] data_o  // two clocks after the address
);
  localparam int unsigned ADDRESS_W = (CELLS > 1) ? $clog2(CELLS) : 1;

  if (CELLS < 1 || CELLS > (1 << CELL_W)) begin : gen_illegal_cells
    $error("gridrt_cells: CELLS must be 1 to 8192");
  end
  if (EXPS < 1 || EXPS > 2) begin : gen_illegal_exps
    $error("gridrt_cells: EXPS must be 1 or 2");
  end

  logic write, b_enable;
  logic [ADDRESS_W-1:0] a_address, b_address;
  logic [RECORD_W-1:0] a_data, b_data;
  assign write = load_i.valid && load_i.kind == gridrt_protocol_pkg::SECTION_KIND_CELLS;
  assign a_address = write ? ADDRESS_W'(load_i.index) : ADDRESS_W'(address_i[0]);
  assign data_o[0] = a_data;
  if (EXPS > 1) begin : gen_second
    assign b_enable = enable_i[1];
    assign b_address = ADDRESS_W'(address_i[1]);
    assign data_o[1] = b_data;
  end else begin : gen_none
    logic unused;
    assign b_enable = 1'b0;
    assign b_address = '0;
    assign unused = &{1'b0, b_data};
  end

  gridrt_ram_tdp #(
      .WIDTH(RECORD_W),
      .DEPTH(CELLS),
      .BANK((CELLS > 2048) ? 2048 : CELLS),
      .OUTPUT_REGISTER(1'b1)
  ) u_records (
      .clk_i,
      .a_write_i(write),
      .a_enable_i(write || enable_i[0]),
      .a_address_i(a_address),
      .a_data_i(load_i.data[RECORD_W-1:0]),
      .a_data_o(a_data),
      .b_enable_i(b_enable),
      .b_address_i(b_address),
      .b_data_o(b_data)
  );

  logic unused_load;
  assign unused_load = &{1'b0, load_i, address_i};
endmodule
