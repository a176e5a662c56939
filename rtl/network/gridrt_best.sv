// The best hit of each ray so far. Events of all PEs end tasks at once; those with a hit are
// compared one a clock, PEs in turn. A smaller quotient lowers the ray's limit: an interrupt to all
// blocks. The key {quotient, id} decides, so the order of events changes no answer.
module gridrt_best #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned PES = 4,
    parameter bit FEEDBACK = 1'b1  // 0: the first hit stays (a wrong machine, for a test)
) (
    input  logic                                     clk_i,
    input  logic                                     rst_ni,
    input  gridrt_pkg::slot_event_t                  alloc_i,
    input  logic                   [PES-1:0]         event_valid_i,
    output logic                   [PES-1:0]         event_ready_o,
    input  logic                   [PES-1:0][gridrt_pkg::EVENT_W-1:0] event_i,  // event_t
    input  logic                   [PES-1:0]         dropped_i,  // the PE ends another task now
    output logic                   [PES-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] end_o,  // tasks that end now
    output gridrt_pkg::interrupt_t                   interrupt_o,
    output gridrt_pkg::event_t                       hit_o,  // the hit that is compared now
    output logic                                     hit_valid_o,
    output logic                   [SLOTS-1:0]       has_hit_o,
    input  logic                   [gridrt_pkg::SLOT_W-1:0] read_slot_i,  // whose id is asked for
    output logic                   [gridrt_pkg::ID_W-1:0]   read_id_o
);
  localparam int unsigned INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;
  localparam int unsigned KEY_W = gridrt_pkg::Q_W + gridrt_pkg::ID_W;

  logic [PES-1:0] request, grant;
  gridrt_pkg::event_t chosen;
  logic [SLOTS-1:0] has_hit;
  logic [KEY_W-1:0] key, best;
  logic first, better, lower;

  gridrt_arbiter #(
      .N(PES)
  ) u_turn (
      .clk_i,
      .rst_ni,
      .request_i(request),
      .take_i(1'b1),
      .grant_o(grant)
  );

  always_comb begin
    chosen = '0;
    for (int unsigned p = 0; p < PES; p++) begin
      if (grant[p]) chosen = chosen | event_i[p];
    end
  end

  for (genvar p = 0; p < PES; p++) begin : gen_event
    gridrt_pkg::event_t one;
    assign one = event_i[p];
    logic may;
    assign may = !(dropped_i[p] && one.last);
    assign request[p] = event_valid_i[p] && one.hit && may;
    assign event_ready_o[p] = may && (!one.hit || grant[p]);
    assign end_o[p] = {event_valid_i[p] && event_ready_o[p] && one.last, one.slot};
    logic unused;
    assign unused = &{1'b0, one.quotient, one.id, one.limit};
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      hit_valid_o <= 1'b0;
      hit_o <= '0;
    end else begin
      hit_valid_o <= request != '0;
      if (request != '0) hit_o <= chosen;
    end
  end

  gridrt_lutram #(
      .WIDTH(KEY_W),
      .DEPTH(SLOTS)
  ) u_best (
      .clk_i,
      .write_i(better),
      .write_address_i(INDEX_W'(hit_o.slot)),
      .write_data_i(key),
      .read_address_i(INDEX_W'(hit_o.slot)),
      .read_data_o(best)
  );
  gridrt_lutram #(
      .WIDTH(gridrt_pkg::ID_W),
      .DEPTH(SLOTS)
  ) u_ids (
      .clk_i,
      .write_i(better),
      .write_address_i(INDEX_W'(hit_o.slot)),
      .write_data_i(hit_o.id),
      .read_address_i(INDEX_W'(read_slot_i)),
      .read_data_o(read_id_o)
  );

  assign key = {hit_o.quotient, hit_o.id};
  assign first = !has_hit[INDEX_W'(hit_o.slot)];
  assign better = hit_valid_o && (first || (FEEDBACK && key < best));
  assign lower = better && (first || hit_o.quotient < best[KEY_W-1:gridrt_pkg::ID_W]);
  assign has_hit_o = has_hit;
  logic unused_slot;
  assign unused_slot = &{1'b0, read_slot_i};  // its upper bits, where there are few slots

  logic [SLOTS-1:0] enters, compared;
  gridrt_onehot #(
      .LINES(SLOTS)
  ) u_enters (
      .valid_i(alloc_i.valid),
      .index_i(INDEX_W'(alloc_i.slot)),
      .line_o (enters)
  );
  gridrt_onehot #(
      .LINES(SLOTS)
  ) u_compared (
      .valid_i(hit_valid_o),
      .index_i(INDEX_W'(hit_o.slot)),
      .line_o (compared)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      has_hit <= '0;
      interrupt_o <= '0;
    end else begin
      has_hit <= (has_hit & ~enters) | compared;
      interrupt_o.valid <= lower;
      if (lower) begin
        interrupt_o.slot  <= hit_o.slot;
        interrupt_o.limit <= hit_o.limit;
      end
    end
  end
endmodule
