-- Signed numbers of VHDL: an integrator with a leak in an entity of its own, a product, a negation and a counter.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity stage is
  generic (W : positive := 8);
  port (clk, rst : in std_logic; x : in signed(W - 1 downto 0); sum : out signed(W + 3 downto 0));
end entity;

architecture rtl of stage is
  signal acc : signed(W + 3 downto 0) := (others => '0');
begin
  process (clk)
  begin
    if rising_edge(clk) then
      if rst = '1' then
        acc <= (others => '0');
      else
        acc <= acc + resize(x, W + 4) - shift_right(acc, 4);
      end if;
    end if;
  end process;
  sum <= acc;
end architecture;

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity filter is
  port (clk, rst : in std_logic; a : in signed(7 downto 0); steps : out unsigned(3 downto 0);
        sum : out std_logic_vector(11 downto 0); product : out signed(15 downto 0); opposite : out signed(7 downto 0);
        share, rest, modulus, size : out signed(7 downto 0));
end entity;

architecture rtl of filter is
  signal level : signed(11 downto 0);
  signal count : unsigned(3 downto 0) := "0000";
begin
  u : entity work.stage generic map (W => 8) port map (clk => clk, rst => rst, x => a, sum => level);
  sum <= std_logic_vector(level);
  steps <= count;
  process (clk)
  begin
    if rising_edge(clk) then
      count <= count + 1;
      product <= a * a;
      opposite <= -a;
      share <= a / to_signed(7, 8);
      rest <= a rem resize(a(4 downto 1) & '1', 8);
      modulus <= a mod resize(a(5 downto 2) & '1', 8);
      size <= abs (a / 2);
    end if;
  end process;
end architecture;
