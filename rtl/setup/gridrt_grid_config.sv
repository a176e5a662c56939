// The constants of a grid from its voxel counts and edges, an addition a clock: blocks per
// axis, the lattice steps they span, and the strides of the block memory. Counts must be
// 1 .. 512 and the blocks fit the block memory (whoever accepts an image checks that).
module gridrt_grid_config (
    input  logic                                                          clk_i,
    input  logic                                                          rst_ni,
    input  logic                                                          start_i,  // a pulse
    input  logic                    [2:0][gridrt_pkg::AXIS_W-1:0]         count_i,  // held until done
    input  logic                    [2:0][gridrt_state_pkg::EDGE_W-1:0]   edge_i,
    output logic                                                          done_o,  // grid_o is valid
    output gridrt_state_pkg::grid_t                                       grid_o
);
  localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W;
  localparam int unsigned SPAN_W = gridrt_state_pkg::SPAN_W;
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;

  logic [2:0][EDGE_W-1:0] edges;
  logic [2:0][SPAN_W-1:0] span;
  logic [2:0][AXIS_W-1:0] half_blocks;
  logic [BLOCK_W-1:0] stride_z;
  // Shift and add, lowest bit first: the spans, and half_blocks x times y for the stride of z.
  logic [2:0][AXIS_W-1:0] bits;
  logic [2:0][SPAN_W-1:0] addend;
  logic [AXIS_W-1:0] stride_bits;
  logic [BLOCK_W-1:0] stride_addend;
  logic load, run, done;

  always_comb begin
    grid_o.edges = edges;
    grid_o.span = span;
    grid_o.half_blocks = half_blocks;
    grid_o.stride[0] = BLOCK_W'(1);
    grid_o.stride[1] = BLOCK_W'(half_blocks[0]);
    grid_o.stride[2] = stride_z;
  end
  assign done_o = done;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      load <= 1'b0;
      run  <= 1'b0;
      done <= 1'b0;
    end else if (start_i) begin
      load <= 1'b1;
      run  <= 1'b0;
      done <= 1'b0;
    end else if (load) begin
      load <= 1'b0;
      run  <= 1'b1;
    end else if (run && bits == '0 && stride_bits == '0) begin
      run  <= 1'b0;
      done <= 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        edges[a] <= edge_i[a];
        half_blocks[a] <= (count_i[a] >> 1) + AXIS_W'(count_i[a][0]);
      end
    end else if (load) begin
      for (int unsigned a = 0; a < 3; a++) begin
        bits[a] <= half_blocks[a];
        addend[a] <= {edges[a], 1'b0};
      end
      span <= '0;
      stride_z <= '0;
      stride_bits <= half_blocks[1];
      stride_addend <= BLOCK_W'(half_blocks[0]);
    end else if (run) begin
      for (int unsigned a = 0; a < 3; a++) begin
        if (bits[a][0]) span[a] <= span[a] + addend[a];
        bits[a] <= bits[a] >> 1;
        addend[a] <= addend[a] << 1;
      end
      if (stride_bits[0]) stride_z <= stride_z + stride_addend;
      stride_bits <= stride_bits >> 1;
      stride_addend <= stride_addend << 1;
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && start_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        assert (count_i[a] >= AXIS_W'(1) && count_i[a] <= AXIS_W'(512));
        assert (edge_i[a] != '0 && edge_i[a] <= (EDGE_W'(1) << gridrt_pkg::MAX_B));
      end
    end
  end
`endif
endmodule
